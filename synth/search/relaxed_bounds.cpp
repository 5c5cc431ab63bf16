// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/relaxed_bounds.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace phonomime {

namespace {

// Where more nodes than this are active (inner pauses), full poses for all of them would cost more
// than they save.
constexpr std::size_t kManyNodes = 4096;

} // namespace

double StepBounds::operator[](NodeIndex node) const {
  const auto place = std::ranges::lower_bound(active, node);
  return place != active.end() && *place == node
             ? bound[static_cast<std::size_t>(place - active.begin())]
             : inactive_bound;
}

JoinFrontier RelaxedRecursion::frontier(const StepBounds& neighbour,
                                        const StepPenalties& penalties) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < neighbour.active.size(); ++i) {
    values.push_back(penalties[neighbour.active[i]] + neighbour.bound[i]);
  }
  return {side_, kernels_, neighbour.active, values};
}

StepBounds RelaxedRecursion::border(const StepPenalties& penalties) const {
  StepBounds bounds;
  bounds.active_penalty = penalties.near();
  bounds.active = penalties.nodes_up_to(bounds.active_penalty);
  bounds.bound.assign(bounds.active.size(), 0.0);
  bounds.partner.assign(bounds.active.size(), kNoNode);
  return bounds;
}

StepBounds RelaxedRecursion::next(const StepPenalties& penalties, const StepBounds& neighbour,
                                  const StepPenalties& neighbour_penalties,
                                  JoinFrontier::Counts& counts) const {
  const double most = penalties.near();
  std::vector<NodeIndex> active = penalties.nodes_up_to(most);
  const std::vector<double> limits(active.size(), std::numeric_limits<double>::infinity());
  StepBounds bounds = bounds_of(std::move(active), limits, neighbour, neighbour_penalties, counts);
  bounds.active_penalty = most;
  return bounds;
}

StepBounds RelaxedRecursion::bounds_of(std::vector<NodeIndex> active,
                                       std::span<const double> limits, const StepBounds& neighbour,
                                       const StepPenalties& neighbour_penalties,
                                       JoinFrontier::Counts& counts) const {
  StepBounds bounds;
  bounds.active = std::move(active);
  bounds.bound.resize(bounds.active.size());
  bounds.partner.assign(bounds.active.size(), kNoNode);
  const bool many = std::max(bounds.active.size(), neighbour.active.size()) > kManyNodes;
  if (!many) {
    kernels_.ensure(bounds.active);
    kernels_.ensure(neighbour.active);
  }
  const JoinFrontier ahead = frontier(neighbour, neighbour_penalties);
  const double least_inactive =
      neighbour_penalties.least_beyond(neighbour.active_penalty) + neighbour.inactive_bound;
  bounds.inactive_bound = std::min(least_inactive, ahead.least_value());

  // Places in `active`, those whose ends are alike near each other.
  const NodeEnd end = side_ == JoinFrontier::Side::later ? NodeEnd::last : NodeEnd::first;
  const std::vector<std::int32_t>& rank = kernels_.sketch.rank(end);
  std::vector<std::size_t> order(bounds.active.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t place) {
    return rank[static_cast<std::size_t>(bounds.active[place])];
  });
  std::vector<NodeIndex> nodes;
  std::ranges::transform(order, std::back_inserter(nodes),
                         [&](std::size_t place) { return bounds.active[place]; });
  std::vector<double> ordered_limits;
  std::ranges::transform(order, std::back_inserter(ordered_limits), [&](std::size_t place) {
    return std::min(limits[place], least_inactive);
  });
  const auto tightness = many ? JoinFrontier::Tightness::rough : JoinFrontier::Tightness::tight;
  ahead.bound_joins({.nodes = nodes, .tightness = tightness, .limits = ordered_limits}, counts,
                    [&](std::size_t i, NodeIndex, const JoinFrontier::Best& best) {
                      bounds.bound[order[i]] = std::min(least_inactive, best.value);
                      bounds.partner[order[i]] = best.node;
                    });
  return bounds;
}

NodeIndex RelaxedRecursion::partner(NodeIndex node, const StepBounds& own,
                                    const StepBounds& neighbour,
                                    const StepPenalties& neighbour_penalties,
                                    JoinFrontier::Counts& counts) const {
  const auto place = std::ranges::lower_bound(own.active, node);
  if (place != own.active.end() && *place == node) {
    const NodeIndex known = own.partner[static_cast<std::size_t>(place - own.active.begin())];
    if (known != kNoNode && neighbour_penalties[known] < std::numeric_limits<double>::infinity()) {
      return known;
    }
  }
  const std::array<NodeIndex, 1> nodes = {node};
  NodeIndex nearest = kNoNode;
  frontier(neighbour, neighbour_penalties)
      .bound_joins(
          {.nodes = nodes}, counts,
          [&](std::size_t, NodeIndex, const JoinFrontier::Best& best) { nearest = best.node; });
  return nearest;
}

} // namespace phonomime
