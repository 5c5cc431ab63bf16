// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/silence.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kRate = 100.0;

// One coefficient: speech frames as given, `gap` unknown frames, speech frames as given.
struct Gap {
  FrameMatrixD frames;
  std::vector<std::uint8_t> shown;

  Gap(const std::vector<double>& before, int gap, const std::vector<double>& after) {
    std::vector<double> values = before;
    values.insert(values.end(), static_cast<std::size_t>(gap), std::nan("")); // nobody may read it
    values.insert(values.end(), after.begin(), after.end());
    frames =
        Eigen::Map<const FrameMatrixD>(values.data(), static_cast<Eigen::Index>(values.size()), 1);
    for (const double value : values) {
      shown.push_back(std::isnan(value) ? 0 : 1);
    }
  }

  std::vector<double> filled(const SilenceOptions& options, double rest = -1.0) {
    fill_silence(frames, shown, Eigen::RowVectorXd::Constant(1, rest), kRate, options);
    return {frames.data(), frames.data() + frames.size()};
  }
};

TEST(Silence, RunsStraightFromBorderToBorder) {
  const auto values = Gap({9.0, 2.0}, 3, {4.0, 9.0}).filled({});
  const std::vector<double> expected = {9.0, 2.0, 2.5, 3.0, 3.5, 4.0, 9.0};
  EXPECT_EQ(values, expected);
}

TEST(Silence, FollowsHalfACosineWave) {
  const auto values = Gap({2.0}, 39, {4.0}).filled({.fill = SilenceFill::cosine});
  for (std::size_t k = 0; k <= 40; ++k) {
    EXPECT_NEAR(values[k], 3.0 - std::cos(std::numbers::pi * static_cast<double>(k) / 40.0), 1e-14);
  }
}

TEST(Silence, FollowsTheHermiteCurveOfItsBordersVelocities) {
  const double a = 1.0, va = 0.5, b = 4.0, vb = -0.25; // a frame
  const int length = 16;
  const auto values =
      Gap({a - va, a}, length - 1, {b, b + vb}).filled({.fill = SilenceFill::cubic});
  for (int k = 0; k <= length; ++k) {
    const double x = static_cast<double>(k) / length;
    const double expected = a * (2 * x * x * x - 3 * x * x + 1) + b * (3 * x * x - 2 * x * x * x) +
                            va * length * (x * x * x - 2 * x * x + x) +
                            vb * length * (x * x * x - x * x);
    EXPECT_NEAR(values[static_cast<std::size_t>(k) + 1], expected, 1e-13);
  }
}

TEST(Silence, DoesNotThrowTheFaceOffInALongPause) {
  const double v = 2.0; // mm a frame
  for (const int length : {21, 50, 200, 1000}) {
    const auto values = Gap({-v, 0.0}, length, {0.0, v}).filled({.fill = SilenceFill::cubic});
    double largest = 0.0;
    double largest_bend = 0.0;
    for (std::size_t k = 1; k + 1 < values.size(); ++k) {
      largest = std::max(largest, std::abs(values[k]));
      largest_bend =
          std::max(largest_bend, std::abs(values[k + 1] - 2 * values[k] + values[k - 1]));
    }
    EXPECT_LT(largest, v * 20.0 * 4.0 / 27.0 + 1e-9) << length; // of d (1 - d / T)^2, T = 0.2 s
    EXPECT_LT(largest_bend, 0.25 * v) << length;                // no corner anywhere
  }
}

TEST(Silence, ReachesTheReferencePoseAtBothEnds) {
  for (const SilenceFill fill : {SilenceFill::linear, SilenceFill::cosine, SilenceFill::cubic}) {
    const auto end = Gap({3.0, 3.0}, 50, {}).filled({.fill = fill});
    const auto start = Gap({}, 50, {3.0, 3.0}).filled({.fill = fill});
    for (std::size_t k = 0; k < end.size(); ++k) {
      EXPECT_EQ(end[k], start[start.size() - 1 - k]) << k; // mirrored in time
      if (k >= 1 + 20) {
        EXPECT_EQ(end[k], -1.0) << k; // 0.2 s after its border, exactly
      } else if (k > 1) {
        EXPECT_LT(end[k], end[k - 1]) << k;
        EXPECT_GT(end[k], -1.0) << k;
      }
    }
  }
}

TEST(Silence, GetsToRestSoonerWhereItIsShortButNeverJumps) {
  for (int length = 1; length <= 60; ++length) {
    const auto values = Gap({19.0, 19.0}, length, {}).filled({});
    if (length >= 10) {
      EXPECT_EQ(values.back(), -1.0) << length;
    }
    for (std::size_t k = 2; k < values.size(); ++k) {
      EXPECT_LE(std::abs(values[k] - values[k - 1]), 20.0 / 10.0 + 1e-12)
          << length; // 0.1 s at least
    }
  }
}

TEST(Silence, RestsInTheReferencePoseItself) {
  for (int k = 1; k < 200; ++k) {
    const double rest = k / 7.0;
    const auto values = Gap({0.1}, 30, {}).filled({}, rest);
    EXPECT_EQ(values[20], rest); // 0.2 s after the border, to the last bit
    EXPECT_EQ(values[30], rest);
  }
}

TEST(Silence, HoldsItsBorderWhereAskedTo) {
  const auto values = Gap({}, 30, {1.0, 3.0}).filled({.rest_at_ends = false});
  for (std::size_t k = 0; k <= 30; ++k) {
    EXPECT_EQ(values[k], 1.0);
  }
}

TEST(Silence, JumpsWhereItMayTakeNoTime) {
  const auto values = Gap({5.0}, 2, {}).filled({.rest_within_s = 0.0});
  const std::vector<double> expected = {5.0, -1.0, -1.0};
  EXPECT_EQ(values, expected);
}

TEST(Silence, RestsWhereNothingIsShown) {
  for (const bool rest_at_ends : {true, false}) {
    const auto values = Gap({}, 7, {}).filled({.rest_at_ends = rest_at_ends});
    EXPECT_EQ(values, std::vector<double>(7, -1.0));
  }
}

TEST(Silence, FillsEveryPauseByItsOwnBorders) {
  const double unknown = std::nan("");
  FrameMatrixD frames(9, 1);
  frames << unknown, unknown, 0.0, unknown, unknown, unknown, 6.0, unknown, unknown;
  fill_silence(frames, {0, 0, 1, 0, 0, 0, 1, 0, 0}, Eigen::RowVectorXd::Zero(1), kRate, {});
  FrameMatrixD expected(9, 1);
  expected << 0.0, 0.0, 0.0, 1.5, 3.0, 4.5, 6.0, 5.4, 4.8; // the last two at the pace of 0.1 s
  EXPECT_TRUE(frames.isApprox(expected, 1e-15));
}

} // namespace
} // namespace phonomime
