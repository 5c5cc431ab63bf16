// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/relaxed_bounds.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace phonomime {

namespace {

// Where one side of a join has more nodes than this (inner pauses), full poses for all of them
// would cost more than they save.
constexpr std::size_t kManyNodes = 4096;

// Places in `nodes`, those whose last ends are alike near each other.
std::vector<std::size_t> order_by_ends(const JoinSketch& sketch,
                                       const std::vector<NodeIndex>& nodes) {
  const std::vector<std::int32_t>& rank = sketch.rank(NodeEnd::last);
  std::vector<std::size_t> order(nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {},
                    [&](std::size_t i) { return rank[static_cast<std::size_t>(nodes[i])]; });
  return order;
}

} // namespace

RelaxedBounds relaxed_bounds(std::span<const StepNodes> nodes, JoinKernels& kernels,
                             JoinFrontier::Counts& counts) {
  const std::size_t last = nodes.size() - 1;
  RelaxedBounds bounds;
  bounds.core_to_go.resize(nodes.size());
  bounds.core_successor.resize(nodes.size());
  bounds.rest_to_go.assign(nodes.size(), 0.0);
  bounds.core_to_go[last].assign(nodes[last].core.size(), 0.0);
  for (std::size_t t = last; t-- > 0;) {
    const StepNodes& next = nodes[t + 1];
    std::vector<double> ahead(next.core.size());
    for (std::size_t j = 0; j < ahead.size(); ++j) {
      ahead[j] = next.core_penalty[j] + bounds.core_to_go[t + 1][j];
    }
    const std::vector<NodeIndex>& core = nodes[t].core;
    const auto tightness = std::max(core.size(), next.core.size()) > kManyNodes
                               ? JoinFrontier::Tightness::rough
                               : JoinFrontier::Tightness::tight;
    if (tightness == JoinFrontier::Tightness::tight) {
      kernels.cost.ensure(next.core);
      kernels.cost.ensure(core);
    }
    const JoinFrontier frontier(JoinFrontier::Side::later, kernels, next.core, ahead);
    const double through_rest = next.rest_penalties.empty()
                                    ? std::numeric_limits<double>::infinity()
                                    : next.rest_penalties.front() + bounds.rest_to_go[t + 1];
    bounds.rest_to_go[t] = std::min(frontier.least_value(), through_rest);
    std::vector<double>& to_go = bounds.core_to_go[t];
    to_go.resize(core.size());
    std::vector<NodeIndex>& successor = bounds.core_successor[t];
    successor.resize(core.size());
    const std::vector<std::size_t> order = order_by_ends(kernels.sketch, core);
    // Neighbours have much the same best join, which is tried first.
    constexpr std::size_t kChunk = 16;
    for_each_in_parallel((core.size() + kChunk - 1) / kChunk, counts,
                         [&](std::size_t chunk, JoinFrontier::Counts& own) {
                           NodeIndex hint = kNoNode;
                           for (std::size_t k = chunk * kChunk;
                                k < std::min(core.size(), (chunk + 1) * kChunk); ++k) {
                             const std::size_t i = order[k];
                             const JoinFrontier::Best best =
                                 frontier.bound_join(core[i], tightness, through_rest, hint, own);
                             to_go[i] = std::min(through_rest, best.value);
                             successor[i] = best.node;
                             hint = best.node;
                           }
                         });
  }
  return bounds;
}

} // namespace phonomime
