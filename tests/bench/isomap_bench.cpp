// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/parallel_for.h"
#include "isomap/density.h"
#include "isomap/geodesics.h"
#include "isomap/isomap.h"
#include "tests/bench/compare.h"
#include "tests/isomap/point_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <nanoflann.hpp>

namespace phonomime {
namespace {

constexpr int kNeighbours = 12;

// Frames as a phoneme cluster has them: a curved sheet in 25 dimensions, noise of a tenth.
FrameMatrix cluster(int count) {
  std::mt19937 random(5);
  return test::trajectory_points(random, count / 10, 10, 25);
}

// The same answer by a k-d tree, on as many threads.
Neighbours by_kd_tree(const FrameMatrixD& points) {
  using Tree = nanoflann::KDTreeEigenMatrixAdaptor<FrameMatrixD, -1, nanoflann::metric_L2_Simple>;
  const Tree tree(static_cast<int>(points.cols()), points, 20);
  Neighbours neighbours;
  neighbours.count = kNeighbours;
  neighbours.index.resize(static_cast<std::size_t>(points.rows() * kNeighbours));
  neighbours.distance.resize(neighbours.index.size());
  constexpr Eigen::Index kAtOnce = 64;
  parallel_for((points.rows() + kAtOnce - 1) / kAtOnce, 0, [&](std::ptrdiff_t share) {
    const Eigen::Index end = std::min((share + 1) * kAtOnce, points.rows());
    for (Eigen::Index i = share * kAtOnce; i < end; ++i) {
      std::array<Eigen::Index, kNeighbours + 1> index;
      std::array<double, kNeighbours + 1> distance_sq;
      nanoflann::KNNResultSet<double, Eigen::Index> result(kNeighbours + 1);
      result.init(index.data(), distance_sq.data());
      tree.index->findNeighbors(result, points.row(i).data(), nanoflann::SearchParams());
      auto at = static_cast<std::size_t>(i * kNeighbours);
      for (std::size_t n = 0; n <= kNeighbours; ++n) {
        if (index[n] != i) {
          neighbours.index[at] = static_cast<std::int32_t>(index[n]);
          neighbours.distance[at++] = std::sqrt(distance_sq[n]);
        }
      }
    }
  });
  return neighbours;
}

void neighbours_against_kd_tree(benchmark::State& state) {
  const FrameMatrix points = cluster(static_cast<int>(state.range(0)));
  const FrameMatrixD exact = points.cast<double>();
  const auto ours = [&] { return nearest_neighbours(points, kNeighbours, 0); };
  const auto plain = [&] { return by_kd_tree(exact); };
  bench::verify(ours().index == plain().index, "nearest_neighbours");
  bench::compare(state, ours, plain);
}
BENCHMARK(neighbours_against_kd_tree)
    ->Arg(1000)
    ->Arg(5000)
    ->Arg(20000)
    ->Arg(50000)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

// Dijkstra's algorithm with the standard library's heap, on as many threads.
DistanceMatrix plain_geodesics(const NeighbourGraph& graph,
                               const std::vector<std::int32_t>& sources) {
  DistanceMatrix distances =
      DistanceMatrix::Constant(static_cast<Eigen::Index>(sources.size()), graph.point_count(),
                               std::numeric_limits<double>::infinity());
  parallel_for(distances.rows(), 0, [&](std::ptrdiff_t s) {
    using Entry = std::pair<double, std::int32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.emplace(0.0, sources[static_cast<std::size_t>(s)]);
    distances(s, queue.top().second) = 0.0;
    while (!queue.empty()) {
      const auto [distance, point] = queue.top();
      queue.pop();
      if (distance > distances(s, point)) {
        continue;
      }
      for (const auto& edge : graph.edges_of(point)) {
        if (distance + edge.length < distances(s, edge.target)) {
          distances(s, edge.target) = distance + edge.length;
          queue.emplace(distance + edge.length, edge.target);
        }
      }
    }
  });
  return distances;
}

void geodesics_against_plain(benchmark::State& state) {
  const FrameMatrix points = cluster(static_cast<int>(state.range(0)));
  const NeighbourGraph graph(static_cast<std::int32_t>(points.rows()),
                             nearest_neighbours(points, kNeighbours, 0));
  std::vector<std::int32_t> sources(static_cast<std::size_t>(state.range(1)));
  std::iota(sources.begin(), sources.end(), 0);
  const auto ours = [&] { return geodesic_distances(graph, sources, 0); };
  const auto plain = [&] { return plain_geodesics(graph, sources); };
  bench::verify(ours() == plain(), "geodesic_distances");
  bench::compare(state, ours, plain);
}
BENCHMARK(geodesics_against_plain)
    ->Args({5000, 5000})
    ->Args({50000, 100})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void maps_of_a_cluster(benchmark::State& state) {
  const FrameMatrix points = cluster(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(build_maps(points, {}));
  }
}
BENCHMARK(maps_of_a_cluster)
    ->Arg(1000)
    ->Arg(5000)
    ->Arg(50000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
