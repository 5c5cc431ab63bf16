// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/neighbour_graph.h"
#include "isomap/shortest_paths.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// Shortest paths from several sources that are near each other, side by side in vector lanes.
// Points are gone through in the order of their distance from the nearest source, which is nearly
// that of each, and a point is taken for all lanes at once; sweeps follow for those that have come
// nearer since, until there are none (Bellman 1958, Ford 1956). Distances are those of
// ShortestPaths to the bit.
class PathsInLanes {
public:
  static constexpr std::size_t kLanes = 16;

  // `graph` must outlive it.
  explicit PathsInLanes(const NeighbourGraph& graph);

  // At most kLanes different sources; rows[i], #points, gets the distances of sources[i].
  void run(std::span<const std::int32_t> sources, std::span<double* const> rows);

private:
  void find_order(std::span<const std::int32_t> sources);
  void sweep();

  const NeighbourGraph& graph_;
  ShortestPaths nearest_; // paths from the nearest source
  std::vector<double> nearest_distance_;
  std::vector<std::size_t> rank_;      // #points: where nearest_ took it last
  std::vector<std::uint64_t> waiting_; // a bit a rank
  std::vector<double> distances_;      // #points by kLanes
  std::vector<std::int32_t> nearer_;   // neighbours that have come nearer
};

} // namespace phonomime
