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

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where more nodes than this are active (inner pauses), full poses for all of them would cost more
// than they save.
constexpr std::size_t kManyNodes = 4096;

// In PNT. What a look at joins could raise a bound by is not worth it below.
constexpr double kTightEnough = 0.03;

} // namespace

double StepBounds::operator[](NodeIndex node) const {
  const auto place = std::ranges::lower_bound(active, node);
  return place != active.end() && *place == node
             ? bound[static_cast<std::size_t>(place - active.begin())]
             : inactive_bound;
}

RelaxedRecursion::Ahead::Ahead(const StepBounds& neighbour, const StepPenalties& penalties)
    : nodes(neighbour.active), least(kInfinity),
      least_inactive(penalties.least_beyond(neighbour.active_penalty) + neighbour.inactive_bound) {
  values.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    values.push_back(penalties[nodes[i]] + neighbour.bound[i]);
    least = std::min(least, values.back());
  }
}

JoinFrontier RelaxedRecursion::frontier(const StepBounds& neighbour,
                                        const StepPenalties& penalties) const {
  return {side_, kernels_, neighbour.active, Ahead(neighbour, penalties).values};
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
                                  JoinFrontier::Counts& counts, KeptJoins* kept) const {
  const double most = penalties.near();
  std::vector<NodeIndex> active = penalties.nodes_up_to(most);
  const std::vector<double> limits(active.size(), kInfinity);
  StepBounds bounds =
      bounds_of(std::move(active), limits, neighbour, neighbour_penalties, counts, kept);
  bounds.active_penalty = most;
  return bounds;
}

StepBounds RelaxedRecursion::bounds_of(std::vector<NodeIndex> active,
                                       std::span<const double> limits, const StepBounds& neighbour,
                                       const StepPenalties& neighbour_penalties,
                                       JoinFrontier::Counts& counts, KeptJoins* kept) const {
  StepBounds bounds;
  bounds.active = std::move(active);
  bounds.bound.resize(bounds.active.size());
  bounds.partner.assign(bounds.active.size(), kNoNode);
  const Ahead ahead(neighbour, neighbour_penalties);
  bounds.inactive_bound = std::min(ahead.least_inactive, ahead.least);
  if (kept != nullptr) {
    kept->reset(bounds.active.size(), ahead.nodes, ahead.values);
  }
  Wanted wanted;
  wanted.places.resize(bounds.active.size());
  std::iota(wanted.places.begin(), wanted.places.end(), std::size_t{0});
  sort_by_ends(wanted.places, bounds.active);
  for (const std::size_t place : wanted.places) {
    wanted.limits.push_back(std::min(limits[place], ahead.least_inactive));
  }
  look(bounds, wanted, ahead, kept, counts);
  return bounds;
}

void RelaxedRecursion::renew(StepBounds& bounds, KeptJoins& kept, const StepPenalties& penalties,
                             const StepBounds& neighbour, const StepPenalties& neighbour_penalties,
                             double within, JoinFrontier::Counts& counts) const {
  const Ahead ahead(neighbour, neighbour_penalties);
  bounds.inactive_bound = std::min(ahead.least_inactive, ahead.least);
  kept.renew(ahead.nodes, ahead.values);
  std::vector<double> value_of(kernels_.cost.table().nodes.size(), kInfinity);
  for (std::size_t i = 0; i < ahead.nodes.size(); ++i) {
    value_of[static_cast<std::size_t>(ahead.nodes[i])] = ahead.values[i];
  }
  const std::size_t size = bounds.active.size();
  std::vector<double> unsure(size); // by how much a look could raise the bound
  std::vector<double> value(size);
  for (std::size_t i = 0; i < size; ++i) {
    const KeptJoins::Least least = kept.least(i, value_of);
    const double by_kept = std::min(ahead.least_inactive, least.value);
    bounds.bound[i] = std::min(by_kept, least.rest);
    bounds.partner[i] = least.node;
    unsure[i] = by_kept - bounds.bound[i];
    value[i] = penalties[bounds.active[i]] + bounds.bound[i];
  }
  const double most = (size == 0 ? 0.0 : std::ranges::min(value)) + within;
  const double tight_enough = kTightEnough * kernels_.cost.weights().pnt;
  Wanted wanted;
  for (std::size_t i = 0; i < size; ++i) {
    if (unsure[i] > tight_enough && value[i] <= most && value[i] < kInfinity) {
      wanted.places.push_back(i);
    }
  }
  if (wanted.places.empty()) {
    return;
  }
  sort_by_ends(wanted.places, bounds.active);
  for (const std::size_t place : wanted.places) {
    wanted.known.push_back(kept.joins(place, value_of, ahead.least_inactive));
  }
  look(bounds, wanted, ahead, &kept, counts);
}

void RelaxedRecursion::look(StepBounds& bounds, const Wanted& wanted, const Ahead& ahead,
                            KeptJoins* kept, JoinFrontier::Counts& counts) const {
  const bool many = std::max(bounds.active.size(), ahead.nodes.size()) > kManyNodes;
  if (!many) {
    kernels_.ensure(bounds.active);
    kernels_.ensure(ahead.nodes);
  }
  std::vector<NodeIndex> nodes;
  std::ranges::transform(wanted.places, std::back_inserter(nodes),
                         [&](std::size_t place) { return bounds.active[place]; });
  JoinFrontier(side_, kernels_, ahead.nodes, ahead.values)
      .bound_joins(
          {.nodes = nodes,
           .tightness = many ? JoinFrontier::Tightness::rough : JoinFrontier::Tightness::tight,
           .limits = wanted.limits,
           .known = wanted.known},
          counts, [&](std::size_t i, NodeIndex, const JoinFrontier::LeastJoins& least) {
            const std::size_t place = wanted.places[i];
            bounds.bound[place] = std::min(ahead.least_inactive, least.value());
            bounds.partner[place] = least.node();
            if (kept != nullptr) {
              kept->keep(place, least);
            }
          });
}

void RelaxedRecursion::sort_by_ends(std::vector<std::size_t>& places,
                                    std::span<const NodeIndex> nodes) const {
  const NodeEnd end = side_ == JoinFrontier::Side::later ? NodeEnd::last : NodeEnd::first;
  const std::vector<std::int32_t>& rank = kernels_.sketch.rank(end);
  std::ranges::sort(
      places, {}, [&](std::size_t place) { return rank[static_cast<std::size_t>(nodes[place])]; });
}

NodeIndex RelaxedRecursion::partner(NodeIndex node, const StepBounds& own,
                                    const StepBounds& neighbour,
                                    const StepPenalties& neighbour_penalties,
                                    JoinFrontier::Counts& counts) const {
  const auto place = std::ranges::lower_bound(own.active, node);
  if (place != own.active.end() && *place == node) {
    const NodeIndex known = own.partner[static_cast<std::size_t>(place - own.active.begin())];
    if (known != kNoNode && neighbour_penalties[known] < kInfinity) {
      return known;
    }
  }
  const std::array<NodeIndex, 1> nodes = {node};
  NodeIndex nearest = kNoNode;
  frontier(neighbour, neighbour_penalties)
      .bound_joins({.nodes = nodes}, counts,
                   [&](std::size_t, NodeIndex, const JoinFrontier::LeastJoins& least) {
                     nearest = least.node();
                   });
  return nearest;
}

} // namespace phonomime
