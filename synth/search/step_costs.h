// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/node_classes.h"
#include "synth/search/search_types.h"

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

// The nodes of one step, split for the search: `core` are those that it looks at one by one, the
// allowed nodes of least penalty (all of them where the step is constrained); of the rest it knows
// the penalties that occur, and lists them only where a bound cannot exclude them.
struct StepNodes {
  std::vector<NodeIndex> core;        // ascending
  std::vector<double> core_penalty;   // OC + EMP of each
  std::vector<double> rest_penalties; // different values, ascending, all above that of the core
};

// Splits the nodes of a table for one step. Throws InternalError where no node is allowed at all.
StepNodes split_step(const MotionTable& table, const NodeClasses& classes, const SearchStep& step,
                     const CostWeights& weights);

// Nodes outside the core whose penalty is `penalty`, ascending. None at a step with allowed nodes.
std::vector<NodeIndex> rest_of_step(const MotionTable& table, const NodeClasses& classes,
                                    const SearchStep& step, const CostWeights& weights,
                                    double penalty);

} // namespace phonomime
