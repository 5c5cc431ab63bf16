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

// In PNT. What a look at joins could raise a bound by is not worth it below.
constexpr double kTightEnough = 0.03;

// So many nodes of a step, or a few more, tell about how little the least of all of them has.
constexpr std::size_t kSample = 64;

} // namespace

double StepBounds::operator[](NodeIndex node) const {
  const auto place = std::ranges::lower_bound(active, node);
  return place != active.end() && *place == node
             ? bound[static_cast<std::size_t>(place - active.begin())]
             : inactive_bound;
}

void NeighbourStep::see(const StepBounds& bounds, const StepPenalties& penalties) {
  std::vector<double> values = penalties.of(bounds.active);
  least = kInfinity;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += bounds.bound[i];
    least = std::min(least, values[i]);
  }
  least_inactive = penalties.least_beyond(bounds.active_penalty) + bounds.inactive_bound;
  frontier.set_values(std::move(values));
}

StepBounds RelaxedRecursion::border(const StepPenalties& penalties) const {
  StepBounds bounds;
  bounds.active_penalty = penalties.near();
  bounds.active = penalties.nodes_up_to(bounds.active_penalty);
  bounds.bound.assign(bounds.active.size(), 0.0);
  bounds.partner.assign(bounds.active.size(), kNoNode);
  return bounds;
}

NeighbourStep RelaxedRecursion::neighbour(const StepBounds& bounds) const {
  return {.frontier = {side_, kernels_, bounds.active}};
}

NeighbourStep RelaxedRecursion::neighbour(const StepBounds& bounds,
                                          const StepPenalties& penalties) const {
  NeighbourStep neighbour = this->neighbour(bounds);
  neighbour.see(bounds, penalties);
  return neighbour;
}

StepBounds RelaxedRecursion::next(const StepPenalties& penalties, const NeighbourStep& neighbour,
                                  JoinFrontier::Counts& counts) const {
  StepBounds bounds = border(penalties);
  bound(bounds, penalties, neighbour, counts);
  return bounds;
}

void RelaxedRecursion::bound(StepBounds& bounds, const StepPenalties& penalties,
                             const NeighbourStep& neighbour, JoinFrontier::Counts& counts,
                             double window, KeptJoins* kept) const {
  bounds.inactive_bound = std::min(neighbour.least_inactive, neighbour.least);
  if (kept != nullptr) {
    kept->reset(bounds.active.size());
  }
  const std::vector<double> own_penalties = penalties.of(bounds.active);
  const std::vector<std::size_t> places = all_places(bounds.active);
  Wanted first; // by which the least of the step is told
  Wanted rest;
  const bool all = window == kInfinity || places.size() < 2 * kSample;
  const std::size_t stride = all ? 1 : places.size() / kSample;
  for (std::size_t i = 0; i < places.size(); ++i) {
    (i % stride == stride / 2 ? first : rest).places.push_back(places[i]);
  }
  first.limits.assign(first.places.size(), neighbour.least_inactive);
  look(bounds, first, neighbour, kept, counts);
  double least = kInfinity;
  for (const std::size_t place : first.places) {
    least = std::min(least, own_penalties[place] + bounds.bound[place]);
  }
  for (const std::size_t place : rest.places) {
    const double limit = least + window - own_penalties[place];
    rest.limits.push_back(std::min(neighbour.least_inactive, std::max(neighbour.least, limit)));
  }
  look(bounds, rest, neighbour, kept, counts);
}

StepBounds RelaxedRecursion::bounds_of(std::vector<NodeIndex> active,
                                       std::span<const double> limits,
                                       const NeighbourStep& neighbour,
                                       JoinFrontier::Counts& counts) const {
  StepBounds bounds;
  bounds.active = std::move(active);
  bounds.bound.resize(bounds.active.size());
  bounds.partner.assign(bounds.active.size(), kNoNode);
  bounds.inactive_bound = std::min(neighbour.least_inactive, neighbour.least);
  Wanted wanted;
  wanted.places = all_places(bounds.active);
  for (const std::size_t place : wanted.places) {
    wanted.limits.push_back(std::min(limits[place], neighbour.least_inactive));
  }
  look(bounds, wanted, neighbour, nullptr, counts);
  for (std::size_t place = 0; place < bounds.active.size(); ++place) {
    if (bounds.partner[place] == kNoNode) {
      bounds.bound[place] = neighbour.least_inactive;
    }
  }
  return bounds;
}

void RelaxedRecursion::renew(StepBounds& bounds, KeptJoins& kept, const StepPenalties& penalties,
                             const NeighbourStep& neighbour, std::span<const double> before,
                             double within, JoinFrontier::Counts& counts) const {
  bounds.inactive_bound = std::min(neighbour.least_inactive, neighbour.least);
  kept.renew(before, neighbour.frontier.values());
  const std::size_t size = bounds.active.size();
  const std::vector<double> own_penalties = penalties.of(bounds.active);
  std::vector<double> unsure(size); // by how much a look could raise the bound
  double least_value = kInfinity;
  for (std::size_t i = 0; i < size; ++i) {
    const KeptJoins::Least least = kept.least(i, neighbour.frontier);
    const double by_kept = std::min(neighbour.least_inactive, least.value);
    bounds.bound[i] = std::min(by_kept, least.rest);
    bounds.partner[i] = least.node;
    unsure[i] = by_kept - bounds.bound[i];
    least_value = std::min(least_value, own_penalties[i] + bounds.bound[i]);
  }
  const double most = least_value + within;
  const double tight_enough = kTightEnough * kernels_.cost.weights().pnt;
  Wanted wanted;
  for (std::size_t i = 0; i < size; ++i) {
    const double value = own_penalties[i] + bounds.bound[i];
    if (unsure[i] > tight_enough && value <= most && value < kInfinity) {
      wanted.places.push_back(i);
    }
  }
  sort_by_ends(wanted.places, bounds.active);
  for (const std::size_t place : wanted.places) {
    wanted.known.push_back(kept.joins(place, neighbour.frontier, neighbour.least_inactive));
  }
  look(bounds, wanted, neighbour, &kept, counts);
}

void RelaxedRecursion::look(StepBounds& bounds, const Wanted& wanted,
                            const NeighbourStep& neighbour, KeptJoins* kept,
                            JoinFrontier::Counts& counts) const {
  if (wanted.places.empty()) {
    return;
  }
  const std::vector<NodeIndex>& ahead = neighbour.frontier.nodes();
  const bool rough = std::max(bounds.active.size(), ahead.size()) > many_;
  if (!rough) {
    kernels_.ensure(bounds.active);
    kernels_.ensure(ahead);
  }
  std::vector<NodeIndex> nodes;
  std::ranges::transform(wanted.places, std::back_inserter(nodes),
                         [&](std::size_t place) { return bounds.active[place]; });
  neighbour.frontier.bound_joins(
      {.nodes = nodes,
       .tightness = rough ? JoinFrontier::Tightness::rough : JoinFrontier::Tightness::tight,
       .limits = wanted.limits,
       .known = wanted.known},
      counts, [&](std::size_t i, NodeIndex, const JoinFrontier::LeastJoins& least) {
        const std::size_t place = wanted.places[i];
        const double found = std::min(least.value(), least.limit());
        bounds.bound[place] = std::min(neighbour.least_inactive, found);
        bounds.partner[place] = least.node();
        if (kept != nullptr) {
          kept->keep(place, least);
        }
      });
}

std::vector<std::size_t> RelaxedRecursion::all_places(std::span<const NodeIndex> nodes) const {
  std::vector<std::size_t> places(nodes.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  sort_by_ends(places, nodes);
  return places;
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
  this->neighbour(neighbour, neighbour_penalties)
      .frontier.bound_joins({.nodes = nodes}, counts,
                            [&](std::size_t, NodeIndex, const JoinFrontier::LeastJoins& least) {
                              nearest = least.node();
                            });
  return nearest;
}

} // namespace phonomime
