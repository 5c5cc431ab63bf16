// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/relaxed_bounds.h"

#include <algorithm>
#include <limits>

namespace phonomime {

RelaxedBounds relaxed_bounds(std::span<const StepNodes> nodes, const JoinCost& cost,
                             const JoinBound& bound, JoinFrontier::Counts& counts) {
  const std::size_t last = nodes.size() - 1;
  RelaxedBounds bounds;
  bounds.core_to_go.resize(nodes.size());
  bounds.rest_to_go.assign(nodes.size(), 0.0);
  bounds.core_to_go[last].assign(nodes[last].core.size(), 0.0);
  for (std::size_t t = last; t-- > 0;) {
    const StepNodes& next = nodes[t + 1];
    std::vector<double> ahead(next.core.size());
    for (std::size_t j = 0; j < ahead.size(); ++j) {
      ahead[j] = next.core_penalty[j] + bounds.core_to_go[t + 1][j];
    }
    const JoinFrontier frontier(JoinFrontier::Side::later, cost, bound, next.core, ahead);
    const double through_rest = next.rest_penalties.empty()
                                    ? std::numeric_limits<double>::infinity()
                                    : next.rest_penalties.front() + bounds.rest_to_go[t + 1];
    bounds.rest_to_go[t] = std::min(frontier.least_value(), through_rest);
    const std::vector<NodeIndex>& core = nodes[t].core;
    std::vector<double>& to_go = bounds.core_to_go[t];
    to_go.resize(core.size());
    for_each_in_parallel(core.size(), counts, [&](std::size_t i, JoinFrontier::Counts& own) {
      to_go[i] = std::min(through_rest, frontier.bound_join(core[i], through_rest, own));
    });
  }
  return bounds;
}

} // namespace phonomime
