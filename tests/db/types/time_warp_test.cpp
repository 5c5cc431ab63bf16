// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/time_warp.h"

#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

FrameMatrix random_node(std::mt19937& random, Eigen::Index frames) {
  std::normal_distribution<float> value(0.0F, 3.0F);
  FrameMatrix node(frames, 4);
  for (Eigen::Index k = 0; k < node.size(); ++k) {
    node.data()[k] = value(random);
  }
  return node;
}

FrameMatrixD warped(const FrameMatrix& node, Eigen::Index frames) {
  FrameMatrixD result(frames, node.cols());
  time_warp(node, result);
  return result;
}

TEST(TimeWarp, KeepsANodeOfItsOwnLengthBitForBit) {
  std::mt19937 random(1);
  for (Eigen::Index n = 1; n <= 60; ++n) {
    const FrameMatrix node = random_node(random, n);
    EXPECT_TRUE(warped(node, n) == node.cast<double>()) << n;
  }
}

TEST(TimeWarp, TakesFrameIOfMAtItsPlaceInTheNode) {
  for (Eigen::Index n = 1; n <= 30; ++n) {
    FrameMatrix ramp(n, 1); // the value of a frame is its index: the warp shows u itself
    for (Eigen::Index i = 0; i < n; ++i) {
      ramp(i, 0) = static_cast<float>(i);
    }
    for (Eigen::Index m = 1; m <= 70; ++m) {
      const FrameMatrixD result = warped(ramp, m);
      for (Eigen::Index i = 0; i < m; ++i) {
        const double u = m == 1 ? 0.5 * static_cast<double>(n - 1)
                                : static_cast<double>(i * (n - 1)) / static_cast<double>(m - 1);
        ASSERT_NEAR(result(i, 0), u, 1e-12) << n << " to " << m << ", frame " << i;
      }
    }
  }
}

TEST(TimeWarp, KeepsFirstAndLastFrameAndStaysBetweenNeighbours) {
  std::mt19937 random(2);
  for (Eigen::Index n = 1; n <= 20; ++n) {
    const FrameMatrix node = random_node(random, n);
    for (Eigen::Index m = 2; m <= 45; ++m) {
      const FrameMatrixD result = warped(node, m);
      EXPECT_TRUE(result.row(0) == node.row(0).cast<double>());
      EXPECT_TRUE(result.row(m - 1) == node.row(n - 1).cast<double>());
      EXPECT_LE(result.maxCoeff(), static_cast<double>(node.maxCoeff()) + 1e-12);
      EXPECT_GE(result.minCoeff(), static_cast<double>(node.minCoeff()) - 1e-12);
    }
  }
}

TEST(TimeWarp, GivesTheMiddleWhereOneFrameIsLeft) {
  FrameMatrix node(4, 1);
  node << 0.0F, 10.0F, 20.0F, 100.0F;
  EXPECT_EQ(warped(node, 1)(0, 0), 15.0);
  EXPECT_EQ(warped(node.topRows(3), 1)(0, 0), 10.0);
}

} // namespace
} // namespace phonomime
