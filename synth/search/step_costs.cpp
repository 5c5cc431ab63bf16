// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/step_costs.h"

#include "db/types/errors.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace phonomime {

double observation_cost(const SearchStep& step, const MotionNode& node,
                        const CostWeights& weights) {
  if (step.is_silence || step.phoneme == node.phoneme) { // rule 1
    return 0.0;
  }
  const double other_phoneme = weights.alpha5 * weights.pnt;
  return step.viseme == node.viseme ? weights.alpha4 * other_phoneme // rule 2
                                    : other_phoneme;                 // rule 3
}

double emotion_cost(const SearchStep& step, const MotionNode& node, const CostWeights& weights) {
  return step.emotion == node.emotion ? 0.0 : weights.alpha6 * weights.pnt;
}

double step_penalty(const SearchStep& step, const MotionNode& node, const CostWeights& weights) {
  return observation_cost(step, node, weights) + emotion_cost(step, node, weights);
}

bool is_allowed(const SearchStep& step, NodeIndex node) {
  return (step.allowed.empty() || std::ranges::binary_search(step.allowed, node)) &&
         !std::ranges::binary_search(step.avoided, node);
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kWorthThreads = 256;
// In PNT. Fits differ from node to node, and more than joins do.
constexpr double kNear = 2.0;
constexpr double kNearWithFit = 3.0;

} // namespace

StepPenalties::StepPenalties(const MotionTable& table, const NodeClasses& classes,
                             const SearchStep& step, const CostWeights& weights, ContextFit& fit)
    : StepPenalties(classes, step, fit, make_free(table, classes, step, weights, fit),
                    weights.pnt) {}

std::shared_ptr<StepPenalties::Free>
StepPenalties::make_free(const MotionTable& table, const NodeClasses& classes,
                         const SearchStep& step, const CostWeights& weights, ContextFit& fit) {
  auto free = std::make_shared<Free>();
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const NodeIndex any = classes.nodes(c).front();
    free->by_class.push_back(
        step_penalty(step, table.nodes[static_cast<std::size_t>(any)], weights));
  }
  free->order.resize(classes.size());
  std::iota(free->order.begin(), free->order.end(), std::size_t{0});
  std::ranges::stable_sort(free->order, {}, [&](std::size_t c) { return free->by_class[c]; });
  if (fit.counts()) {
    free->wish = fit.wish(step, classes);
  }
  free->fits.resize(free->wish.asks ? classes.size() : 0);
  return free;
}

void StepPenalties::learn_fits(std::size_t class_index) const {
  std::vector<double>& sums = free_->fits[class_index];
  if (!sums.empty()) {
    return;
  }
  const std::span<const NodeIndex> nodes = classes_.nodes(class_index);
  fit_.ensure(nodes);
  sums.resize(nodes.size());
#pragma omp parallel for schedule(static) if (nodes.size() > kWorthThreads)
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    sums[i] = fit_.fit(free_->wish, nodes[i], true).sum();
  }
}

StepPenalties::StepPenalties(const NodeClasses& classes, const SearchStep& step, ContextFit& fit,
                             std::shared_ptr<Free> free, double pnt)
    : classes_(classes), step_(step), fit_(fit), free_(std::move(free)), pnt_(pnt),
      least_(kInfinity), near_(kInfinity) {
  const auto add = [&](std::span<const NodeIndex> nodes) {
    for (const NodeIndex node : nodes) {
      const double penalty = (*this)[node];
      least_ = std::min(least_, penalty);
      if (!free_->wish.asks && penalty < kInfinity) {
        return; // all of them have the same
      }
    }
  };
  for (const NodeIndex& node : step.allowed) {
    add(std::span(&node, 1));
  }
  for (const std::size_t c : free_->order) {
    if (!step.allowed.empty() || free_->by_class[c] >= least_) {
      break;
    }
    if (free_->wish.asks) {
      learn_fits(c);
    }
    add(classes.nodes(c));
  }
  if (least_ == kInfinity) {
    throw InternalError({.what = "a step of the search has no node that is allowed"});
  }
  near_ = least_ + (free_->wish.asks ? kNearWithFit : kNear) * pnt;
}

StepPenalties StepPenalties::under(const SearchStep& step, double further) const {
  StepPenalties constrained(classes_, step, fit_, free_, pnt_);
  constrained.near_ += further;
  return constrained;
}

double StepPenalties::operator[](NodeIndex node) const {
  return is_allowed(step_, node) ? free_penalty(node) : kInfinity;
}

std::vector<double> StepPenalties::of(std::span<const NodeIndex> nodes) const {
  std::vector<double> penalties;
  penalties.reserve(nodes.size());
  auto avoided = step_.avoided.begin();
  for (const NodeIndex node : nodes) {
    while (avoided != step_.avoided.end() && *avoided < node) {
      ++avoided;
    }
    const bool blocked =
        (avoided != step_.avoided.end() && *avoided == node) ||
        (!step_.allowed.empty() && !std::ranges::binary_search(step_.allowed, node));
    penalties.push_back(blocked ? kInfinity : free_penalty(node));
  }
  return penalties;
}

double StepPenalties::free_penalty(NodeIndex node) const {
  const std::size_t c = classes_.class_of(node);
  if (free_->wish.asks && free_->fits[c].empty()) {
    return free_->by_class[c] + fit_.fit(free_->wish, node, false).sum();
  }
  return free_penalty(c, free_->wish.asks ? classes_.place_of(node) : 0);
}

double StepPenalties::free_penalty(std::size_t class_index, std::size_t place) const {
  return free_->wish.asks ? free_->by_class[class_index] + free_->fits[class_index][place]
                          : free_->by_class[class_index];
}

FitCost StepPenalties::fit_of(NodeIndex node) const {
  return free_->wish.asks
             ? fit_.fit(free_->wish, node, !free_->fits[classes_.class_of(node)].empty())
             : FitCost{};
}

std::vector<NodeIndex> StepPenalties::nodes_up_to(double most) const {
  std::vector<NodeIndex> members;
  const auto append = [&](std::span<const NodeIndex> nodes) {
    std::ranges::copy_if(nodes, std::back_inserter(members),
                         [&](NodeIndex node) { return is_allowed(step_, node); });
  };
  append(step_.allowed);
  for (std::size_t c = 0; step_.allowed.empty() && c < classes_.size(); ++c) {
    if (free_->by_class[c] > most) {
      continue;
    }
    if (!free_->wish.asks || most == kInfinity) {
      append(classes_.nodes(c));
    } else {
      learn_fits(c);
      const std::span<const NodeIndex> nodes = classes_.nodes(c);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (free_penalty(c, i) <= most && is_allowed(step_, nodes[i])) {
          members.push_back(nodes[i]);
        }
      }
    }
  }
  std::ranges::sort(members);
  return members;
}

double StepPenalties::least_beyond(double most) const {
  double least = kInfinity;
  for (std::size_t c = 0; step_.allowed.empty() && c < classes_.size(); ++c) {
    if (free_->by_class[c] > most) {
      least = std::min(least, free_->by_class[c]);
    } else if (free_->wish.asks && most < kInfinity) {
      learn_fits(c);
      const std::span<const NodeIndex> nodes = classes_.nodes(c);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double penalty = free_penalty(c, i);
        if (penalty > most && penalty < least && is_allowed(step_, nodes[i])) {
          least = penalty;
        }
      }
    }
  }
  return least;
}

std::int64_t StepPenalties::allowed_count() const {
  if (step_.allowed.empty()) {
    return classes_.node_count() - static_cast<std::int64_t>(step_.avoided.size());
  }
  return std::ranges::count_if(step_.allowed,
                               [&](NodeIndex node) { return is_allowed(step_, node); });
}

} // namespace phonomime
