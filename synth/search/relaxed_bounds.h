// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_frontier.h"
#include "synth/search/step_costs.h"

#include <span>
#include <vector>

namespace phonomime {

// Lower bounds of the cost of everything after a step, by one backward pass in which joins cost
// their bound, and joins with nodes outside the core cost nothing but the penalty of those nodes.
struct RelaxedBounds {
  std::vector<std::vector<double>> core_to_go;        // per step, per node of its core
  std::vector<std::vector<NodeIndex>> core_successor; // whose join it is; kNoNode for one outside
  std::vector<double> rest_to_go;                     // per step: for any node outside the core
};

// One entry of `nodes` per step, at least one.
RelaxedBounds relaxed_bounds(std::span<const StepNodes> nodes, JoinKernels& kernels,
                             JoinFrontier::Counts& counts);

} // namespace phonomime
