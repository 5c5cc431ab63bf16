// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/geodesics.h"
#include "tests/isomap/point_sets.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

DistanceMatrix floyd_warshall(const NeighbourGraph& graph) {
  const Eigen::Index n = graph.point_count();
  DistanceMatrix distances = DistanceMatrix::Constant(n, n, kInfinity);
  for (Eigen::Index i = 0; i < n; ++i) {
    distances(i, i) = 0.0;
    for (const auto& edge : graph.edges_of(static_cast<std::int32_t>(i))) {
      distances(i, edge.target) = edge.length;
    }
  }
  for (Eigen::Index via = 0; via < n; ++via) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        distances(i, j) = std::min(distances(i, j), distances(i, via) + distances(via, j));
      }
    }
  }
  return distances;
}

// Dijkstra's algorithm as it is in books.
std::vector<double> dijkstra(const NeighbourGraph& graph, std::int32_t source) {
  std::vector<double> distance(static_cast<std::size_t>(graph.point_count()), kInfinity);
  using Entry = std::pair<double, std::int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  distance[static_cast<std::size_t>(source)] = 0.0;
  queue.push({0.0, source});
  while (!queue.empty()) {
    const auto [from, point] = queue.top();
    queue.pop();
    for (const NeighbourGraph::Edge& edge : graph.edges_of(point)) {
      double& to = distance[static_cast<std::size_t>(edge.target)];
      if (from + edge.length < to) {
        to = from + edge.length;
        queue.push({to, edge.target});
      }
    }
  }
  return distance;
}

void expect_dijkstra(const NeighbourGraph& graph, const std::vector<std::int32_t>& sources) {
  const DistanceMatrix found = geodesic_distances(graph, sources, 2);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const std::vector<double> expected = dijkstra(graph, sources[s]);
    const auto row = found.row(static_cast<Eigen::Index>(s));
    ASSERT_TRUE(std::equal(expected.begin(), expected.end(), row.begin())) << s;
  }
}

std::vector<std::int32_t> all_of(const NeighbourGraph& graph) {
  std::vector<std::int32_t> sources(static_cast<std::size_t>(graph.point_count()));
  std::iota(sources.begin(), sources.end(), 0);
  return sources;
}

void expect_floyd_warshall(const NeighbourGraph& graph) {
  const DistanceMatrix expected = floyd_warshall(graph);
  const DistanceMatrix found = geodesic_distances(graph, all_of(graph), 1);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    for (Eigen::Index j = 0; j < expected.cols(); ++j) {
      if (expected(i, j) == kInfinity) {
        ASSERT_EQ(found(i, j), kInfinity) << i << " to " << j;
      } else {
        ASSERT_NEAR(found(i, j), expected(i, j), 1e-12 * (1.0 + expected(i, j)))
            << i << " to " << j;
      }
    }
  }
  EXPECT_EQ(found, geodesic_distances(graph, all_of(graph), 2));
}

TEST(Geodesics, EqualFloydWarshall) {
  std::mt19937 random(21);
  for (const int k : {2, 4, 12}) {
    const FrameMatrix points = test::trajectory_points(random, 20, 10, 25);
    expect_floyd_warshall(NeighbourGraph(200, nearest_neighbours(points, k, 1)));
  }
}

TEST(Geodesics, OfEqualAndZeroLengthsEqualFloydWarshall) {
  std::mt19937 random(22);
  std::uniform_int_distribution<int> coordinate(0, 4);
  FrameMatrix points(120, 2);
  std::generate_n(points.data(), points.size(),
                  [&] { return static_cast<float>(coordinate(random)); });
  expect_floyd_warshall(NeighbourGraph(120, nearest_neighbours(points, 8, 1)));
}

// Sources that are many, few, one more than once; in graphs of several parts.
TEST(Geodesics, EqualDijkstraToTheBit) {
  std::mt19937 random(24);
  const FrameMatrix points = test::trajectory_points(random, 100, 10, 25);
  for (const int k : {2, 12}) {
    const NeighbourGraph graph(1000, nearest_neighbours(points, k, 1));
    expect_dijkstra(graph, all_of(graph));
    expect_dijkstra(graph, {999, 0, 400, 0, 1, 999});
    std::vector<std::int32_t> shuffled = all_of(graph);
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    shuffled.insert(shuffled.end(), {7, 7, 8});
    expect_dijkstra(graph, shuffled);
  }
}

// A ladder whose rungs and rails are of any length: the order of points from one source is far from
// that from the next.
TEST(Geodesics, InAnUnevenGraphEqualDijkstraToTheBit) {
  std::mt19937 random(25);
  std::lognormal_distribution<double> length(0.0, 3.0);
  std::vector<PointPair> edges;
  for (std::int32_t i = 0; i + 2 < 600; ++i) {
    edges.push_back({i, i + 2, length(random)});
    if (i % 2 == 0) {
      edges.push_back({i, i + 1, length(random)});
    }
  }
  const NeighbourGraph graph(600, Neighbours{}, edges);
  expect_dijkstra(graph, all_of(graph));
}

TEST(Geodesics, ThatDoNotExistAreInfinite) {
  FrameMatrix points(6, 1);
  points << 0.0F, 1.0F, 2.0F, 100.0F, 101.0F, 102.0F;
  const NeighbourGraph graph(6, nearest_neighbours(points, 1, 1));
  const std::vector<std::int32_t> sources = {2, 3};
  const DistanceMatrix distances = geodesic_distances(graph, sources, 1);
  EXPECT_EQ(distances.row(0),
            (Eigen::RowVectorXd(6) << 2, 1, 0, kInfinity, kInfinity, kInfinity).finished());
  EXPECT_EQ(distances.row(1),
            (Eigen::RowVectorXd(6) << kInfinity, kInfinity, kInfinity, 0, 1, 2).finished());
}

TEST(Geodesics, StopWhenAsked) {
  std::mt19937 random(23);
  const NeighbourGraph graph(50, nearest_neighbours(test::uniform_points(random, 50, 3), 4, 1));
  const std::atomic<bool> stop = true;
  EXPECT_THROW(geodesic_distances(graph, all_of(graph), 1, {.report = {}, .stop = &stop}),
               Interrupted);
}

} // namespace
} // namespace phonomime
