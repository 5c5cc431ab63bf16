// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/step_costs.h"

#include "db/types/errors.h"

#include <algorithm>
#include <limits>

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

// All nodes of the table, by penalty.
void split_free_step(const MotionTable& table, const SearchStep& step, const CostWeights& weights,
                     StepNodes& nodes) {
  double least = std::numeric_limits<double>::infinity();
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    if (std::ranges::binary_search(step.avoided, node)) {
      continue;
    }
    const double own = step_penalty(step, table.nodes[static_cast<std::size_t>(node)], weights);
    const auto place = std::ranges::lower_bound(nodes.rest_penalties, own);
    if (place == nodes.rest_penalties.end() || *place != own) {
      nodes.rest_penalties.insert(place, own);
    }
    if (own < least) {
      least = own;
      nodes.core.clear();
    }
    if (own == least) {
      nodes.core.push_back(node);
    }
  }
  nodes.core_penalty.assign(nodes.core.size(), least);
  if (!nodes.rest_penalties.empty()) {
    nodes.rest_penalties.erase(nodes.rest_penalties.begin());
  }
}

} // namespace

StepNodes split_step(const MotionTable& table, const SearchStep& step, const CostWeights& weights) {
  StepNodes nodes;
  if (step.allowed.empty()) {
    split_free_step(table, step, weights, nodes);
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

std::vector<NodeIndex> rest_of_step(const MotionTable& table, const SearchStep& step,
                                    const CostWeights& weights, const StepNodes& nodes,
                                    double penalty) {
  std::vector<NodeIndex> members;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    if (step_penalty(step, table.nodes[static_cast<std::size_t>(node)], weights) == penalty &&
        is_allowed(step, node) && !std::ranges::binary_search(nodes.core, node)) {
      members.push_back(node);
    }
  }
  return members;
}

} // namespace phonomime
