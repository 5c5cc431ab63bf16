// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/bounds_to_go.h"

#include <algorithm>
#include <cstdint>

namespace phonomime {

namespace {

// In PNT. A good path has no node whose cost, with all that follows, is much further above the
// least of its step.
constexpr double kWindow = 1.25;

// In PNT. Active nodes that were the near ones go on to be as long as near reaches less further.
constexpr double kStillNear = 0.5;

// A node takes some 200 bytes in a frontier. So many in all are kept, and none of a step of more
// than a few: inner pauses, and phonemes that were never recorded.
constexpr std::size_t kKeptNodes = std::size_t{1} << 19;
constexpr std::size_t kKeptNodesOfStep = std::size_t{1} << 12;

} // namespace

BoundsToGo::BoundsToGo(JoinKernels& kernels, const Progress& progress, bool further)
    : recursion_(kernels, JoinFrontier::Side::later), progress_(progress), further_(further),
      pnt_(kernels.cost.weights().pnt) {}

void BoundsToGo::keep_where_there_is_room() {
  std::size_t room = kKeptNodes;
  for (std::size_t t = 0; t < bounds_.size(); ++t) {
    const std::size_t nodes = bounds_[t].active.size();
    seen_[t].kept = nodes <= std::min(room, kKeptNodesOfStep);
    room -= seen_[t].kept ? nodes : 0;
  }
#pragma omp parallel for schedule(dynamic)
  for (std::size_t t = 0; t < bounds_.size(); ++t) {
    if (seen_[t].kept) {
      seen_[t].step.emplace(recursion_.neighbour(bounds_[t]));
    }
  }
}

void BoundsToGo::see(std::size_t t, const StepPenalties& penalties) {
  std::optional<NeighbourStep>& step = seen_[t].step;
  if (!step) {
    step.emplace(recursion_.neighbour(bounds_[t]));
  }
  step->see(bounds_[t], penalties);
}

void BoundsToGo::leave(std::size_t t) {
  seen_[t].values = seen_[t].step->frontier.values();
  if (!seen_[t].kept) {
    seen_[t].step.reset();
  }
}

void BoundsToGo::make(std::span<const StepPenalties> penalties, JoinFrontier::Counts& counts) {
  const std::size_t size = penalties.size();
  bounds_.clear();
  for (const StepPenalties& step : penalties) {
    bounds_.push_back(recursion_.border(step));
  }
  seen_.clear();
  seen_.resize(size);
  keep_where_there_is_room();
  kept_.assign(further_ ? size : 0, {});
  for (std::size_t t = size; t-- > 0;) {
    progress_.update("search", 0, static_cast<std::int64_t>(size));
    if (t + 1 < size) {
      recursion_.bound(bounds_[t], penalties[t], *seen_[t + 1].step, counts, kWindow * pnt_,
                       further_ ? &kept_[t] : nullptr);
      leave(t + 1);
    }
    see(t, penalties[t]);
  }
}

void BoundsToGo::renew(std::span<const StepPenalties> penalties, double within,
                       JoinFrontier::Counts& counts) {
  const std::size_t size = penalties.size();
  for (std::size_t t = 0; t < size; ++t) {
    if (penalties[t].near() > bounds_[t].active_penalty + kStillNear * pnt_) {
      make(penalties, counts);
      return;
    }
  }
  for (std::size_t t = size; t-- > 0;) {
    progress_.update("search", 0, static_cast<std::int64_t>(size));
    if (t + 1 < size) {
      recursion_.renew(bounds_[t], kept_[t], penalties[t], *seen_[t + 1].step, seen_[t + 1].values,
                       within, counts);
      leave(t + 1);
    }
    see(t, penalties[t]);
  }
}

} // namespace phonomime
