// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/geodesics.h"

#include "db/types/parallel_for.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace phonomime {

namespace {

constexpr std::ptrdiff_t kSourcesAtOnce = 16;    // a thread's share
constexpr std::ptrdiff_t kSourcesAReport = 1024; // between looks at Progress
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Dijkstra's algorithm with a heap of four children a node, which knows where each point stands.
class ShortestPaths {
public:
  explicit ShortestPaths(const NeighbourGraph& graph)
      : graph_(graph), place_(static_cast<std::size_t>(graph.point_count())),
        heap_(static_cast<std::size_t>(graph.point_count())) {}

  // `distance`: #points.
  void run(std::int32_t source, double* distance) {
    std::fill_n(distance, graph_.point_count(), kInfinity);
    distance[source] = 0.0;
    size_ = 0;
    put(size_++, {0.0, source});
    while (size_ > 0) {
      const Entry nearest = heap_.front();
      if (--size_ > 0) {
        sink(heap_[size_]);
      }
      for (const NeighbourGraph::Edge& edge : graph_.edges_of(nearest.point)) {
        const double length = nearest.distance + edge.length;
        double& known = distance[edge.target];
        if (length < known) {
          const std::size_t place =
              known == kInfinity ? size_++ : place_[static_cast<std::size_t>(edge.target)];
          known = length;
          rise(place, {length, edge.target});
        }
      }
    }
  }

private:
  struct Entry {
    double distance;
    std::int32_t point;
  };

  void put(std::size_t place, const Entry& entry) {
    heap_[place] = entry;
    place_[static_cast<std::size_t>(entry.point)] = static_cast<std::uint32_t>(place);
  }
  void rise(std::size_t place, const Entry& entry) {
    while (place > 0) {
      const std::size_t parent = (place - 1) / 4;
      if (heap_[parent].distance <= entry.distance) {
        break;
      }
      put(place, heap_[parent]);
      place = parent;
    }
    put(place, entry);
  }
  // The root is gone, and `entry` has lost its place at the end.
  void sink(const Entry entry) {
    std::size_t place = 0;
    for (std::size_t child = 1; child < size_; child = 4 * place + 1) {
      const std::size_t end = std::min(child + 4, size_);
      std::size_t least = child;
      for (std::size_t other = child + 1; other < end; ++other) {
        least = heap_[other].distance < heap_[least].distance ? other : least;
      }
      if (heap_[least].distance >= entry.distance) {
        break;
      }
      put(place, heap_[least]);
      place = least;
    }
    put(place, entry);
  }

  const NeighbourGraph& graph_;
  std::vector<std::uint32_t> place_; // #points, into heap_
  std::vector<Entry> heap_;
  std::size_t size_ = 0;
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
