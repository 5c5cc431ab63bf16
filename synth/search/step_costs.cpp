// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/step_costs.h"

#include "db/types/errors.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>

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

} // namespace

StepPenalties::StepPenalties(const MotionTable& table, const NodeClasses& classes,
                             const SearchStep& step, const CostWeights& weights)
    : classes_(classes), step_(step), least_(kInfinity), near_(kInfinity) {
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const NodeIndex any = classes.nodes(c).front();
    by_class_.push_back(step_penalty(step, table.nodes[static_cast<std::size_t>(any)], weights));
  }
  const auto add = [&](std::span<const NodeIndex> nodes) {
    const auto open =
        std::ranges::find_if(nodes, [&](NodeIndex node) { return (*this)[node] < kInfinity; });
    if (open != nodes.end()) {
      least_ = std::min(least_, (*this)[*open]);
    }
  };
  for (const NodeIndex& node : step.allowed) {
    add(std::span(&node, 1));
  }
  for (std::size_t c = 0; step.allowed.empty() && c < classes.size(); ++c) {
    add(classes.nodes(c));
  }
  if (least_ == kInfinity) {
    throw InternalError({.what = "a step of the search has no node that is allowed"});
  }
  constexpr double kNear = 2.0; // PNT
  near_ = least_ + kNear * weights.pnt;
}

double StepPenalties::operator[](NodeIndex node) const {
  return is_allowed(step_, node) ? by_class_[classes_.class_of(node)] : kInfinity;
}

std::vector<NodeIndex> StepPenalties::nodes_up_to(double most) const {
  std::vector<NodeIndex> members;
  const auto append = [&](std::span<const NodeIndex> nodes) {
    std::ranges::copy_if(nodes, std::back_inserter(members),
                         [&](NodeIndex node) { return is_allowed(step_, node); });
  };
  append(step_.allowed);
  for (std::size_t c = 0; step_.allowed.empty() && c < classes_.size(); ++c) {
    if (by_class_[c] <= most) {
      append(classes_.nodes(c));
    }
  }
  std::ranges::sort(members);
  return members;
}

double StepPenalties::least_beyond(double most) const {
  double least = kInfinity;
  for (std::size_t c = 0; step_.allowed.empty() && c < classes_.size(); ++c) {
    if (by_class_[c] > most) {
      least = std::min(least, by_class_[c]);
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
