// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/paths_in_lanes.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace phonomime {

namespace {

constexpr std::size_t kLanes = PathsInLanes::kLanes;
constexpr std::size_t kParts = kLanes / kDoubleLanes;
constexpr std::size_t kPointsAtOnce = 64; // whose distances the first-level cache keeps
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using LaneBits = std::int64_t __attribute__((vector_size(sizeof(DoubleLanes))));

inline bool any(const LaneBits& bits) {
  return (bits[0] | bits[1] | bits[2] | bits[3]) != 0;
}

// Goes the `edges` of a point at the distances `from`. `distances`: #points by kLanes; `nearer`
// gets the targets of which one has become less. How many.
PHONOMIME_DISPATCHED std::size_t go_edges(const double* from, const NeighbourGraph::Edge* edges,
                                          std::size_t edge_count, double* distances,
                                          std::int32_t* nearer) {
  DoubleLanes start[kParts];
  std::memcpy(start, from, sizeof start);
  std::size_t count = 0;
  for (std::size_t e = 0; e < edge_count; ++e) {
    double* target = distances + static_cast<std::size_t>(edges[e].target) * kLanes;
    DoubleLanes least[kParts];
    LaneBits changed = {};
    for (std::size_t part = 0; part < kParts; ++part) {
      DoubleLanes before;
      load(before, target + part * kDoubleLanes);
      const DoubleLanes length = start[part] + edges[e].length;
      least[part] = length < before ? length : before;
      changed |= reinterpret_cast<LaneBits>(least[part]) ^ reinterpret_cast<LaneBits>(before);
    }
    if (any(changed)) {
      std::memcpy(target, least, sizeof least);
      nearer[count++] = edges[e].target;
    }
  }
  return count;
}

} // namespace

PathsInLanes::PathsInLanes(const NeighbourGraph& graph)
    : graph_(graph), nearest_(graph),
      nearest_distance_(static_cast<std::size_t>(graph.point_count())),
      rank_(nearest_distance_.size()), distances_(nearest_distance_.size() * kLanes),
      nearer_(nearest_distance_.size()) {}

void PathsInLanes::find_order(std::span<const std::int32_t> sources) {
  nearest_.run(sources, nearest_distance_.data());
  const std::vector<std::int32_t>& order = nearest_.taken();
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    rank_[static_cast<std::size_t>(order[rank])] = rank;
  }
  waiting_.assign(order.size() / 64 + 1, 0);
}

void PathsInLanes::sweep() {
  for (std::size_t word = 0; word < waiting_.size(); ++word) {
    while (waiting_[word] != 0) {
      const auto rank = word * 64 + static_cast<std::size_t>(std::countr_zero(waiting_[word]));
      waiting_[word] &= waiting_[word] - 1;
      const std::int32_t point = nearest_.taken()[rank];
      const std::span<const NeighbourGraph::Edge> edges = graph_.edges_of(point);
      const std::size_t count =
          go_edges(distances_.data() + static_cast<std::size_t>(point) * kLanes, edges.data(),
                   edges.size(), distances_.data(), nearer_.data());
      for (std::size_t n = 0; n < count; ++n) {
        const std::size_t next = rank_[static_cast<std::size_t>(nearer_[n])];
        waiting_[next / 64] |= std::uint64_t{1} << next % 64;
      }
    }
  }
}

void PathsInLanes::run(std::span<const std::int32_t> sources, std::span<double* const> rows) {
  find_order(sources);
  std::fill(distances_.begin(), distances_.end(), kInfinity);
  for (std::size_t lane = 0; lane < sources.size(); ++lane) {
    const auto source = static_cast<std::size_t>(sources[lane]);
    distances_[source * kLanes + lane] = 0.0;
    waiting_[rank_[source] / 64] |= std::uint64_t{1} << rank_[source] % 64;
  }
  while (std::any_of(waiting_.begin(), waiting_.end(), [](auto word) { return word != 0; })) {
    sweep();
  }
  const std::size_t point_count = rank_.size();
  for (std::size_t first = 0; first < point_count; first += kPointsAtOnce) {
    const std::size_t end = std::min(first + kPointsAtOnce, point_count);
    for (std::size_t lane = 0; lane < rows.size(); ++lane) {
      for (std::size_t point = first; point < end; ++point) {
        rows[lane][point] = distances_[point * kLanes + lane];
      }
    }
  }
}

} // namespace phonomime
