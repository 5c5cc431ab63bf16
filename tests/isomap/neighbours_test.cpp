// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/neighbours.h"
#include "tests/isomap/point_sets.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// All others of a point, nearest first, ties by index: by sorting.
std::vector<std::pair<double, std::int32_t>> sorted_others(const FrameMatrix& points,
                                                           Eigen::Index i) {
  std::vector<std::pair<double, std::int32_t>> others;
  for (Eigen::Index j = 0; j < points.rows(); ++j) {
    if (j != i) {
      double sum = 0.0;
      for (Eigen::Index d = 0; d < points.cols(); ++d) {
        sum += std::pow(static_cast<double>(points(i, d)) - static_cast<double>(points(j, d)), 2);
      }
      others.emplace_back(sum, static_cast<std::int32_t>(j));
    }
  }
  std::sort(others.begin(), others.end());
  return others;
}

void expect_exact(const FrameMatrix& points, int k) {
  const Neighbours found = nearest_neighbours(points, k, 1);
  const auto count = static_cast<std::size_t>(points.rows());
  ASSERT_EQ(found.count, std::min<int>(k, static_cast<int>(count) - 1));
  for (std::size_t i = 0; i < count; ++i) {
    const auto others = sorted_others(points, static_cast<Eigen::Index>(i));
    for (std::size_t n = 0; n < static_cast<std::size_t>(found.count); ++n) {
      ASSERT_EQ(found.of(i)[n], others[n].second) << "neighbour " << n << " of point " << i;
      ASSERT_DOUBLE_EQ(found.distances_of(i)[n], std::sqrt(others[n].first));
    }
  }
  const Neighbours by_two = nearest_neighbours(points, k, 2);
  EXPECT_EQ(found.index, by_two.index);
  EXPECT_EQ(found.distance, by_two.distance);
}

TEST(Neighbours, EqualSortingInEveryDimension) {
  std::mt19937 random(1);
  for (const int dimensions : {1, 2, 5, 6, 7, 25, 40}) {
    SCOPED_TRACE(dimensions);
    expect_exact(test::uniform_points(random, 300, dimensions), 12);
  }
  expect_exact(test::trajectory_points(random, 150, 15, 25), 12);
}

TEST(Neighbours, EqualSortingFarFromTheOrigin) {
  // Differences of a thousandth of the coordinates: products of coordinates would have lost them.
  std::mt19937 random(2);
  FrameMatrix points = test::uniform_points(random, 400, 25, 10.0);
  points.array() += 10000.0F;
  expect_exact(points, 12);
}

TEST(Neighbours, EqualSortingWhereManyAreEquallyFar) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> coordinate(0, 3);
  FrameMatrix points(500, 3);
  std::generate_n(points.data(), points.size(),
                  [&] { return static_cast<float>(coordinate(random)); });
  expect_exact(points, 12);
}

TEST(Neighbours, EqualSortingAtTheEndsOfFloat) {
  std::mt19937 random(4);
  expect_exact(test::uniform_points(random, 100, 4, 1e-25), 5);
  expect_exact(test::uniform_points(random, 100, 4, 1e18), 5);
}

TEST(Neighbours, OfFewPoints) {
  std::mt19937 random(5);
  for (const int count : {2, 3, 8, 9, 12, 13, 14}) {
    SCOPED_TRACE(count);
    expect_exact(test::uniform_points(random, count, 25), 12);
  }
  EXPECT_EQ(nearest_neighbours(FrameMatrix::Zero(1, 25), 12, 1).count, 0);
  EXPECT_EQ(nearest_neighbours(FrameMatrix(0, 25), 12, 1).count, 0);
}

} // namespace
} // namespace phonomime
