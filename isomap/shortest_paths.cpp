// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/shortest_paths.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace phonomime {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostBuckets = 4096.0;

} // namespace

ShortestPaths::ShortestPaths(const NeighbourGraph& graph)
    : graph_(graph), taken_at_(static_cast<std::size_t>(graph.point_count())) {
  double sum = 0.0, longest = 0.0;
  std::size_t count = 0;
  for (std::int32_t point = 0; point < graph.point_count(); ++point) {
    for (const NeighbourGraph::Edge& edge : graph.edges_of(point)) {
      sum += edge.length;
      longest = std::max(longest, edge.length);
      ++count;
    }
  }
  // Half a mean edge wide, but not so narrow that the longest edge spans too many.
  const double width = std::max(0.5 * sum / static_cast<double>(std::max<std::size_t>(count, 1)),
                                longest / kMostBuckets);
  per_width_ = width > 0.0 ? 1.0 / width : 0.0;
  buckets_.resize(std::bit_ceil(static_cast<std::size_t>(longest * per_width_) + 2));
}

void ShortestPaths::put(std::int32_t point, double distance) {
  buckets_[static_cast<std::size_t>(distance * per_width_) & (buckets_.size() - 1)].push_back(
      point);
  ++waiting_;
}

void ShortestPaths::run(std::span<const std::int32_t> sources, double* distance) {
  std::fill_n(distance, graph_.point_count(), kInfinity);
  std::fill(taken_at_.begin(), taken_at_.end(), kInfinity);
  taken_.clear();
  for (const std::int32_t source : sources) {
    distance[source] = 0.0;
    put(source, 0.0);
  }
  for (std::size_t current = 0; waiting_ > 0; ++current) {
    std::vector<std::int32_t>& bucket = buckets_[current & (buckets_.size() - 1)];
    while (!bucket.empty()) {
      const std::int32_t point = bucket.back();
      bucket.pop_back();
      --waiting_;
      const double from = distance[point];
      if (taken_at_[static_cast<std::size_t>(point)] == from) {
        continue; // it stood in several buckets
      }
      taken_at_[static_cast<std::size_t>(point)] = from;
      taken_.push_back(point);
      for (const NeighbourGraph::Edge& edge : graph_.edges_of(point)) {
        const double length = from + edge.length;
        if (length < distance[edge.target]) {
          distance[edge.target] = length;
          put(edge.target, length);
        }
      }
    }
  }
}

} // namespace phonomime
