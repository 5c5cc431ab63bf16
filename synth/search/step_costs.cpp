// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/step_costs.h"

#include "db/types/errors.h"

#include <algorithm>
#include <iterator>

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

double class_penalty(const MotionTable& table, const NodeClasses& classes, std::size_t class_index,
                     const SearchStep& step, const CostWeights& weights) {
  const NodeIndex any = classes.nodes(class_index).front();
  return step_penalty(step, table.nodes[static_cast<std::size_t>(any)], weights);
}

// Adds the nodes of a class that the step does not avoid.
void append_allowed(const SearchStep& step, std::span<const NodeIndex> nodes,
                    std::vector<NodeIndex>& to) {
  std::ranges::copy_if(nodes, std::back_inserter(to), [&](NodeIndex node) {
    return !std::ranges::binary_search(step.avoided, node);
  });
}

// All nodes of the table, by penalty.
void split_free_step(const MotionTable& table, const NodeClasses& classes, const SearchStep& step,
                     const CostWeights& weights, StepNodes& nodes) {
  std::vector<double> penalties;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const bool some = std::ranges::any_of(classes.nodes(c), [&](NodeIndex node) {
      return !std::ranges::binary_search(step.avoided, node);
    });
    if (some) {
      penalties.push_back(class_penalty(table, classes, c, step, weights));
    }
  }
  std::ranges::sort(penalties);
  penalties.erase(std::unique(penalties.begin(), penalties.end()), penalties.end());
  if (penalties.empty()) {
    return;
  }
  nodes.core = rest_of_step(table, classes, step, weights, penalties.front());
  nodes.core_penalty.assign(nodes.core.size(), penalties.front());
  nodes.rest_penalties.assign(penalties.begin() + 1, penalties.end());
}

} // namespace

StepNodes split_step(const MotionTable& table, const NodeClasses& classes, const SearchStep& step,
                     const CostWeights& weights) {
  StepNodes nodes;
  if (step.allowed.empty()) {
    split_free_step(table, classes, step, weights, nodes);
  }
  for (const NodeIndex node : step.allowed) {
    if (is_allowed(step, node)) {
      nodes.core.push_back(node);
      nodes.core_penalty.push_back(
          step_penalty(step, table.nodes[static_cast<std::size_t>(node)], weights));
    }
  }
  if (nodes.core.empty()) {
    throw InternalError({.what = "a step of the search has no node that is allowed"});
  }
  return nodes;
}

std::vector<NodeIndex> rest_of_step(const MotionTable& table, const NodeClasses& classes,
                                    const SearchStep& step, const CostWeights& weights,
                                    double penalty) {
  std::vector<NodeIndex> members;
  for (std::size_t c = 0; step.allowed.empty() && c < classes.size(); ++c) {
    if (class_penalty(table, classes, c, step, weights) == penalty) {
      append_allowed(step, classes.nodes(c), members);
    }
  }
  std::ranges::sort(members);
  return members;
}

} // namespace phonomime
