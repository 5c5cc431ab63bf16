// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/bounds_to_go.h"

#include <cstddef>

namespace phonomime {

namespace {

// In PNT. A good path has no node whose cost, with all that follows, is much further above the
// least of its step.
constexpr double kWindow = 1.25;

// In PNT. Active nodes that were the near ones go on to be as long as near reaches less further.
constexpr double kStillNear = 0.5;

} // namespace

BoundsToGo::BoundsToGo(JoinKernels& kernels, const Progress& progress, bool further)
    : recursion_(kernels, JoinFrontier::Side::later), progress_(progress), further_(further),
      pnt_(kernels.cost.weights().pnt) {}

void BoundsToGo::make(std::span<const StepPenalties> penalties, JoinFrontier::Counts& counts) {
  const std::size_t size = penalties.size();
  steps_.clear();
  for (const StepPenalties& step : penalties) {
    steps_.push_back(recursion_.border(step));
  }
  seen_ = recursion_.neighbours(steps_);
  kept_.assign(further_ ? size : 0, {});
  for (std::size_t t = size; t-- > 0;) {
    progress_.update("search", 0, static_cast<std::int64_t>(size));
    if (t + 1 < size) {
      recursion_.bound(steps_[t], penalties[t], seen_[t + 1], counts, kWindow * pnt_,
                       further_ ? &kept_[t] : nullptr);
    }
    seen_[t].see(steps_[t], penalties[t]);
  }
}

void BoundsToGo::renew(std::span<const StepPenalties> penalties, double within,
                       JoinFrontier::Counts& counts) {
  const std::size_t size = penalties.size();
  for (std::size_t t = 0; t < size; ++t) {
    if (penalties[t].near() > steps_[t].active_penalty + kStillNear * pnt_) {
      make(penalties, counts);
      return;
    }
  }
  std::vector<double> before; // the values of the step ahead
  for (std::size_t t = size; t-- > 0;) {
    progress_.update("search", 0, static_cast<std::int64_t>(size));
    if (t + 1 < size) {
      recursion_.renew(steps_[t], kept_[t], penalties[t], seen_[t + 1], before, within, counts);
    }
    before = seen_[t].frontier.values();
    seen_[t].see(steps_[t], penalties[t]);
  }
}

} // namespace phonomime
