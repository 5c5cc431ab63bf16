// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/geodesics.h"

#include "db/types/parallel_for.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

namespace phonomime {

namespace {

constexpr std::ptrdiff_t kSourcesAtOnce = 16;    // a thread's share
constexpr std::ptrdiff_t kSourcesAReport = 1024; // between looks at Progress
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Shortest paths from one point by buckets of distances (Dial 1969; Meyer and Sanders 2003): points
// are taken bucket by bucket, those of one bucket in any order, and again where they come nearer. A
// distance is the least over all paths of the sum of their edges from the source on, to the bit, as
// it is by Dijkstra's algorithm, whose heap takes longer.
class ShortestPaths {
public:
  explicit ShortestPaths(const NeighbourGraph& graph)
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

  // `distance`: #points.
  void run(std::int32_t source, double* distance) {
    std::fill_n(distance, graph_.point_count(), kInfinity);
    std::fill(taken_at_.begin(), taken_at_.end(), kInfinity);
    distance[source] = 0.0;
    buckets_.front().push_back(source);
    const std::size_t ring = buckets_.size() - 1;
    std::size_t waiting = 1;
    for (std::size_t current = 0; waiting > 0; ++current) {
      std::vector<std::int32_t>& bucket = buckets_[current & ring];
      while (!bucket.empty()) {
        const std::int32_t point = bucket.back();
        bucket.pop_back();
        --waiting;
        const double from = distance[point];
        if (taken_at_[static_cast<std::size_t>(point)] == from) {
          continue; // it stood in several buckets
        }
        taken_at_[static_cast<std::size_t>(point)] = from;
        for (const NeighbourGraph::Edge& edge : graph_.edges_of(point)) {
          const double length = from + edge.length;
          if (length < distance[edge.target]) {
            distance[edge.target] = length;
            buckets_[static_cast<std::size_t>(length * per_width_) & ring].push_back(edge.target);
            ++waiting;
          }
        }
      }
    }
  }

private:
  static constexpr double kMostBuckets = 4096.0;

  const NeighbourGraph& graph_;
  std::vector<double> taken_at_; // #points: the distance at which a point was last taken
  double per_width_ = 0.0;       // buckets a unit of distance
  std::vector<std::vector<std::int32_t>> buckets_; // a ring, a power of two: no edge spans it
};

} // namespace

DistanceMatrix geodesic_distances(const NeighbourGraph& graph,
                                  std::span<const std::int32_t> sources, int threads,
                                  const Progress& progress) {
  const auto source_count = static_cast<std::ptrdiff_t>(sources.size());
  DistanceMatrix distances(source_count, graph.point_count());
  for (std::ptrdiff_t begin = 0; begin < source_count; begin += kSourcesAReport) {
    progress.update("geodesics", begin, source_count);
    const std::ptrdiff_t end = std::min(begin + kSourcesAReport, source_count);
    const std::ptrdiff_t shares = (end - begin + kSourcesAtOnce - 1) / kSourcesAtOnce;
    parallel_for(shares, threads, [&](std::ptrdiff_t share) {
      ShortestPaths paths(graph);
      const std::ptrdiff_t first = begin + share * kSourcesAtOnce;
      for (std::ptrdiff_t i = first; i < std::min(first + kSourcesAtOnce, end); ++i) {
        paths.run(sources[static_cast<std::size_t>(i)], distances.row(i).data());
      }
    });
  }
  progress.update("geodesics", source_count, source_count);
  return distances;
}

} // namespace phonomime
