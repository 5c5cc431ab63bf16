// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/node_classes.h"
#include "synth/search/search_types.h"

#include <cstdint>
#include <vector>

namespace phonomime {

// OC of E Table II.
double observation_cost(const SearchStep& step, const MotionNode& node, const CostWeights& weights);

// EMP of E5.
double emotion_cost(const SearchStep& step, const MotionNode& node, const CostWeights& weights);

// OC + EMP of a node at a step.
double step_penalty(const SearchStep& step, const MotionNode& node, const CostWeights& weights);

// B of E10: whether the node may stand at the step.
bool is_allowed(const SearchStep& step, NodeIndex node);

// OC + EMP of the nodes of a table at one step, infinite where B blocks a node.
class StepPenalties {
public:
  // Keeps references to `classes` and `step`. Throws InternalError where B blocks every node.
  StepPenalties(const MotionTable& table, const NodeClasses& classes, const SearchStep& step,
                const CostWeights& weights);

  double operator[](NodeIndex node) const;
  double least() const { return least_; } // of the nodes that are not blocked

  // The most that a node near the least has: 2 PNT above it. Nodes further off are looked at only
  // where bounds cannot exclude them.
  double near() const { return near_; }

  // The nodes of a penalty up to `most`, ascending; all that are allowed where the step names them.
  std::vector<NodeIndex> nodes_up_to(double most) const;
  // At most the least penalty of any other node than nodes_up_to(most); infinite where none is
  // left.
  double least_beyond(double most) const;

  std::int64_t allowed_count() const;

private:
  const NodeClasses& classes_;
  const SearchStep& step_;
  std::vector<double> by_class_;
  double least_;
  double near_;
};

} // namespace phonomime
