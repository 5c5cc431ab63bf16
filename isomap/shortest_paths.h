// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/neighbour_graph.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// Shortest paths by buckets of distances (Dial 1969; Meyer and Sanders 2003): points are taken
// bucket by bucket, those of one bucket in any order, and again where they come nearer. A distance
// is the least over all paths of the sum of their edges from the source on, to the bit, as it is by
// Dijkstra's algorithm, whose heap takes longer.
class ShortestPaths {
public:
  // `graph` must outlive it.
  explicit ShortestPaths(const NeighbourGraph& graph);

  // Distances from the nearest of `sources`; infinity where there is no path. `distance`: #points.
  void run(std::span<const std::int32_t> sources, double* distance);

  // The points in the order in which they were taken, as often as they were.
  const std::vector<std::int32_t>& taken() const { return taken_; }

private:
  void put(std::int32_t point, double distance);

  const NeighbourGraph& graph_;
  std::vector<double> taken_at_; // #points: the distance at which a point was last taken
  std::vector<std::int32_t> taken_;
  double per_width_ = 0.0;                         // buckets a unit of distance
  std::vector<std::vector<std::int32_t>> buckets_; // a ring, a power of two: no edge spans it
  std::size_t waiting_ = 0;                        // points in buckets
};

} // namespace phonomime
