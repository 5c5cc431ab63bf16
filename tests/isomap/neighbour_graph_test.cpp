// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/neighbour_graph.h"
#include "tests/isomap/point_sets.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Kruskal's minimum spanning tree over components, from all pairs of points.
std::vector<PointPair> spanning_tree(const FrameMatrix& points, const Components& components) {
  std::vector<PointPair> pairs;
  for (std::int32_t a = 0; a < points.rows(); ++a) {
    for (std::int32_t b = a + 1; b < points.rows(); ++b) {
      pairs.push_back({a, b, (points.row(a) - points.row(b)).cast<double>().norm()});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const PointPair& x, const PointPair& y) {
    return std::tie(x.length, x.a, x.b) < std::tie(y.length, y.a, y.b);
  });
  std::vector<std::int32_t> label = components.of_point;
  std::vector<PointPair> tree;
  for (const PointPair& pair : pairs) {
    const std::int32_t from = label[static_cast<std::size_t>(pair.a)];
    const std::int32_t to = label[static_cast<std::size_t>(pair.b)];
    if (from != to) {
      std::replace(label.begin(), label.end(), from, to);
      tree.push_back(pair);
    }
  }
  return tree;
}

FrameMatrix clumps(std::mt19937& random, int count, int points_each) {
  FrameMatrix points = test::uniform_points(random, count * points_each, 5);
  const FrameMatrix centres = test::uniform_points(random, count, 5, 100.0);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) += centres.row(i / points_each);
  }
  return points;
}

std::set<std::pair<std::int32_t, std::int32_t>> ends(const std::vector<PointPair>& pairs) {
  std::set<std::pair<std::int32_t, std::int32_t>> result;
  for (const PointPair& pair : pairs) {
    result.emplace(pair.a, pair.b);
  }
  return result;
}

TEST(NeighbourGraph, IsSymmetricAndHoldsEveryNeighbour) {
  std::mt19937 random(11);
  const FrameMatrix points = test::uniform_points(random, 200, 4);
  const Neighbours neighbours = nearest_neighbours(points, 6, 1);
  const NeighbourGraph graph(200, neighbours);
  std::set<std::pair<std::int32_t, std::int32_t>> expected;
  for (std::int32_t i = 0; i < 200; ++i) {
    for (const std::int32_t j : neighbours.of(static_cast<std::size_t>(i))) {
      expected.emplace(i, j);
      expected.emplace(j, i);
    }
  }
  std::set<std::pair<std::int32_t, std::int32_t>> found;
  for (std::int32_t i = 0; i < 200; ++i) {
    for (const auto& edge : graph.edges_of(i)) {
      EXPECT_TRUE(found.emplace(i, edge.target).second) << "an edge stands twice";
      EXPECT_NEAR(edge.length, (points.row(i) - points.row(edge.target)).norm(), 1e-6);
    }
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(graph.edge_count() * 2, expected.size());
  EXPECT_GT(expected.size(), neighbours.index.size()) << "no neighbour was one-sided";
}

TEST(NeighbourGraph, FindsComponentsBySize) {
  std::mt19937 random(12);
  FrameMatrix points = clumps(random, 4, 10);
  points.row(39) = points.row(0); // the last clump has 9 points, the first 11
  const Components components =
      find_components(NeighbourGraph(40, nearest_neighbours(points, 3, 1)));
  EXPECT_EQ(components.sizes, (std::vector<std::int32_t>{11, 10, 10, 9}));
  for (std::size_t i = 0; i < 39; ++i) {
    EXPECT_EQ(components.of_point[i], static_cast<std::int32_t>(i / 10));
  }
  EXPECT_EQ(components.of_point[39], 0);
}

TEST(NeighbourGraph, IsJoinedByAMinimumSpanningTree) {
  std::mt19937 random(13);
  for (int round = 0; round < 8; ++round) {
    const FrameMatrix points = clumps(random, 12, 6 + round);
    const Neighbours neighbours = nearest_neighbours(points, 3, 1);
    const auto count = static_cast<std::int32_t>(points.rows());
    const Components components = find_components(NeighbourGraph(count, neighbours));
    ASSERT_GE(components.sizes.size(), 12U);
    const std::vector<PointPair> edges = joining_edges(points, components, 1);
    EXPECT_EQ(ends(edges), ends(spanning_tree(points, components)));
    EXPECT_EQ(ends(edges), ends(joining_edges(points, components, 2)));
    EXPECT_EQ(find_components(NeighbourGraph(count, neighbours, edges)).sizes,
              std::vector<std::int32_t>{count});
  }
}

TEST(NeighbourGraph, OfDuplicatesFallsApartAndIsJoined) {
  FrameMatrix points(30, 2); // three places, ten times each: every neighbour is a duplicate
  for (Eigen::Index i = 0; i < 30; ++i) {
    points.row(i) << static_cast<float>(i % 3), 0.0F;
  }
  const Neighbours neighbours = nearest_neighbours(points, 5, 1);
  const Components components = find_components(NeighbourGraph(30, neighbours));
  EXPECT_EQ(components.sizes.size(), 3U);
  const std::vector<PointPair> edges = joining_edges(points, components, 1);
  ASSERT_EQ(edges.size(), 2U);
  EXPECT_EQ(edges[0].length, 1.0);
  EXPECT_EQ(edges[1].length, 1.0);
}

} // namespace
} // namespace phonomime
