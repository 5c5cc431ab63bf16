// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/frame_products.h"

#include <gtest/gtest.h>

#include <random>

namespace phonomime {
namespace {

// Small whole numbers: every sum is exact, in whatever order.
FrameMatrixD whole_numbers(Eigen::Index frames, Eigen::Index channels, unsigned seed) {
  std::mt19937 random(seed);
  FrameMatrixD matrix(frames, channels);
  for (double& value : matrix.reshaped()) {
    value = static_cast<double>(random() % 2001) - 1000.0;
  }
  return matrix;
}

TEST(FrameProducts, AreThoseOfTheFramesTransposedWithThemselves) {
  for (const Eigen::Index channels : {1, 3, 4, 7, 8, 9, 16, 33, 61}) {
    for (const Eigen::Index frames : {0, 1, 2, 255, 256, 257, 700}) {
      const FrameMatrixD matrix = whole_numbers(frames, channels, 7);
      const Eigen::MatrixXd expected = (matrix.transpose() * matrix).eval();
      EXPECT_EQ(frame_products(matrix, 1), expected) << frames << " frames of " << channels;
      EXPECT_EQ(frame_products(matrix, 3), expected) << frames << " frames of " << channels;
    }
  }
}

TEST(FrameProducts, OfAPartOfAMatrixLeaveTheRestAlone) {
  const FrameMatrixD matrix = whole_numbers(300, 40, 8);
  const FrameMatrixD part = matrix.middleRows(10, 270).middleCols(3, 21);
  EXPECT_EQ(frame_products(matrix.middleRows(10, 270).middleCols(3, 21), 2),
            (part.transpose() * part).eval());
}

TEST(FrameProducts, ThreadsChangeNoBit) {
  FrameMatrixD matrix = whole_numbers(1000, 50, 9);
  matrix /= 3.0;
  const Eigen::MatrixXd one = frame_products(matrix, 1);
  EXPECT_EQ(one, one.transpose().eval());
  for (const int threads : {2, 3, 8}) {
    EXPECT_EQ(frame_products(matrix, threads), one);
  }
}

} // namespace
} // namespace phonomime
