// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/weight_filter.h"

#include "db/types/errors.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kRate_hz = 100.0;

// A wave around 0.5 at some frequency: 400 frames by 1.
FrameMatrixD wave(double frequency_hz) {
  return FrameMatrixD::NullaryExpr(400, 1, [&](Eigen::Index t, Eigen::Index) {
    return 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * frequency_hz * static_cast<double>(t) /
                                kRate_hz);
  });
}

TEST(WeightFilter, AtNoneLeavesEveryBit) {
  const FrameMatrixD weights = wave(7.0);
  EXPECT_EQ(filter_weights(weights, kRate_hz, 0.0), weights);
}

TEST(WeightFilter, WeakensAWaveAsABellDoesAndMovesNothingInTime) {
  for (const double width_s : {0.01, 0.03, 0.06}) {
    for (const double frequency_hz : {1.0, 3.0, 6.0}) {
      const FrameMatrixD weights = wave(frequency_hz);
      const FrameMatrixD filtered = filter_weights(weights, kRate_hz, width_s);
      const double product = 2.0 * std::numbers::pi * width_s * frequency_hz;
      const double share = std::exp(-0.5 * product * product);
      for (Eigen::Index t = 50; t < 350; ++t) { // away from the ends
        EXPECT_NEAR(filtered(t, 0) - 0.5, share * (weights(t, 0) - 0.5), 2e-4);
      }
    }
  }
}

TEST(WeightFilter, StaysWithinTheBoundsAndKeepsConstants) {
  FrameMatrixD weights = FrameMatrixD::Zero(60, 3);
  weights.col(1).setConstant(0.3);
  weights.col(2).tail(30).setOnes();
  const FrameMatrixD filtered = filter_weights(weights, kRate_hz, 0.2);
  EXPECT_EQ(filtered.leftCols(2), weights.leftCols(2));
  EXPECT_GE(filtered.minCoeff(), 0.0);
  EXPECT_LE(filtered.maxCoeff(), 1.0);
  for (Eigen::Index t = 1; t < 60; ++t) { // a step becomes a slope
    EXPECT_GT(filtered(t, 2), filtered(t - 1, 2));
  }
  EXPECT_EQ(filter_weights(weights.topRows(1), kRate_hz, 0.1), weights.topRows(1));
  EXPECT_EQ(filter_weights(weights.topRows(0), kRate_hz, 0.1).rows(), 0);
}

TEST(WeightFilter, RefusesANegativeWidth) {
  EXPECT_THROW(filter_weights(wave(1.0), kRate_hz, -0.1), UsageError);
}

} // namespace
} // namespace phonomime
