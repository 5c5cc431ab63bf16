// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace phonomime {
namespace {

FrameMatrixD sampled(double rate_hz, double seconds, double frequency_hz) {
  FrameMatrixD frames(static_cast<Eigen::Index>(rate_hz * seconds), 2);
  for (Eigen::Index k = 0; k < frames.rows(); ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    frames.row(k) << std::sin(2.0 * std::numbers::pi * frequency_hz * t), 3.0 - 2.0 * t;
  }
  return frames;
}

TEST(Resample, AtRecordedTimesItIsTheRecordedFrame) {
  const FrameMatrixD frames = sampled(25.0, 2.0, 3.0);
  const FrameMatrixD same = resample(frames, {.rate_hz = 25.0, .start_s = 0.0}, 25.0, 50);
  EXPECT_EQ(same, frames);
  const FrameMatrixD up = resample(frames, {.rate_hz = 25.0, .start_s = 0.0}, 100.0, 200);
  for (Eigen::Index k = 0; k < 50; ++k) {
    EXPECT_EQ(up.row(4 * k), frames.row(k)) << k;
  }
}

TEST(Resample, UpwardsItFollowsASlowMotionAndALine) {
  const FrameMatrixD up =
      resample(sampled(30.0, 4.0, 1.0), {.rate_hz = 30.0, .start_s = 0.0}, 100.0, 390);
  const FrameMatrixD truth = sampled(100.0, 3.9, 1.0);
  EXPECT_LT((up.col(0) - truth.col(0)).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT((up.col(1) - truth.col(1)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Resample, UpwardsItStaysBetweenTheFramesBesideIt) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  FrameMatrixD frames(60, 3);
  for (double& value : frames.reshaped()) {
    value = normal(random);
  }
  const FrameMatrixD up = resample(frames, {.rate_hz = 25.0, .start_s = 0.0}, 120.0, 280);
  for (Eigen::Index k = 0; k < up.rows(); ++k) {
    const auto i = std::min<Eigen::Index>(58, k * 25 / 120);
    for (Eigen::Index c = 0; c < 3; ++c) {
      EXPECT_GE(up(k, c), std::min(frames(i, c), frames(i + 1, c)) - 1e-12);
      EXPECT_LE(up(k, c), std::max(frames(i, c), frames(i + 1, c)) + 1e-12);
    }
  }
}

TEST(Resample, DownwardsItKeepsWhatFitsAndRemovesWhatWouldFold) {
  const SourceClock fast{.rate_hz = 240.0, .start_s = 0.0};
  const FrameMatrixD kept = resample(sampled(240.0, 4.0, 10.0), fast, 60.0, 240);
  const FrameMatrixD truth = sampled(60.0, 4.0, 10.0);
  EXPECT_LT((kept - truth).middleRows(20, 200).cwiseAbs().maxCoeff(), 2e-3);
  const FrameMatrixD folded = resample(sampled(240.0, 4.0, 45.0), fast, 60.0, 240);
  EXPECT_LT(folded.col(0).segment(20, 200).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((kept.col(1) - truth.col(1)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Resample, OutsideTheRecordingItsEndsAreHeld) {
  const FrameMatrixD frames = sampled(50.0, 1.0, 2.0);
  const FrameMatrixD up = resample(frames, {.rate_hz = 50.0, .start_s = 0.015}, 100.0, 105);
  EXPECT_EQ(up.row(0), frames.row(0));
  EXPECT_EQ(up.row(1), frames.row(0));
  EXPECT_EQ(up.row(104), frames.row(49));
  EXPECT_NE(up.row(3), frames.row(1));
}

TEST(Resample, TurnsAreFollowedAlongTheArc) {
  std::vector<HeadPose> head;
  for (int k = 0; k < 50; ++k) {
    const Eigen::AngleAxisd turn(0.05 * k, Eigen::Vector3d(1, 2, 2).normalized());
    head.push_back({.translation_mm = {1.0 * k, 0, 0}, .rotation = Eigen::Quaterniond(turn)});
  }
  const std::vector<HeadPose> up =
      resample_head(head, {.rate_hz = 25.0, .start_s = 0.0}, 100.0, 197);
  for (std::size_t k = 0; k < up.size(); ++k) {
    const Eigen::Quaterniond truth(Eigen::AngleAxisd(0.05 * static_cast<double>(k) / 4.0,
                                                     Eigen::Vector3d(1, 2, 2).normalized()));
    EXPECT_LT(up[k].rotation.angularDistance(truth), 1e-3) << k;
    EXPECT_NEAR(up[k].rotation.norm(), 1.0, 1e-12);
    EXPECT_NEAR(up[k].translation_mm.x(), static_cast<double>(k) / 4.0, 1e-9);
  }
}

TEST(Resample, MarksReachEveryFrameThatDrawsOnThem) {
  std::vector<std::uint8_t> marks(10, 0);
  marks[4] = 1;
  const auto up = resample_marks(marks, {.rate_hz = 25.0, .start_s = 0.0}, 100.0, 40);
  for (std::size_t k = 0; k < up.size(); ++k) {
    EXPECT_EQ(up[k], k > 12 && k < 20) << k;
  }
}

} // namespace
} // namespace phonomime
