// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/blend.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kRate_hz = 100.0;

FrameMatrixD random_motion(std::uint32_t seed, Eigen::Index frames = 80) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  FrameMatrixD motion(frames, 4);
  for (double& value : motion.reshaped()) {
    value = normal(random);
  }
  return motion;
}

FrameMatrixD mean_of(const std::vector<FrameMatrixD>& motions) {
  FrameMatrixD mean = FrameMatrixD::Zero(motions[0].rows(), motions[0].cols());
  for (const FrameMatrixD& motion : motions) {
    mean += motion / static_cast<double>(motions.size());
  }
  return mean;
}

TEST(Blend, OneMotionAndMotionsAllAlikeComeBack) {
  const FrameMatrixD motion = random_motion(1);
  EXPECT_EQ(blend_motions(std::vector<FrameMatrixD>{motion}, {}, kRate_hz), motion);
  const std::vector<FrameMatrixD> alike(5, motion);
  EXPECT_LT((blend_motions(alike, {}, kRate_hz) - motion).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Blend, WithoutLivelinessItIsTheMean) {
  const std::vector<FrameMatrixD> motions = {random_motion(1), random_motion(2), random_motion(3)};
  const BlendOptions plain{.liveliness = 0.0, .expected_share = 0.25};
  EXPECT_LT((blend_motions(motions, {}, kRate_hz, plain) - mean_of(motions)).cwiseAbs().maxCoeff(),
            1e-12);
  const FrameMatrixD expected = random_motion(9);
  const FrameMatrixD mixed = 0.75 * mean_of(motions) + 0.25 * expected;
  EXPECT_LT((blend_motions(motions, expected, kRate_hz, plain) - mixed).cwiseAbs().maxCoeff(),
            1e-12);
}

// Sines of one frequency, so that a gaussian passes each by the same share: with all the energy
// restored the blend is the sine that the motions have in common, as large as they are on average.
TEST(Blend, AllLivelinessGivesTheEnergyOfTheMotionsBack) {
  for (const double frequency_hz : {1.0, 20.0}) { // slow, fast
    std::vector<FrameMatrixD> motions;
    for (const double phase : {-0.7, 0.0, 0.7}) {
      FrameMatrixD motion(400, 2);
      for (Eigen::Index k = 0; k < motion.rows(); ++k) {
        const double turn =
            2.0 * std::numbers::pi * frequency_hz * static_cast<double>(k) / kRate_hz;
        motion.row(k) << 7.0 + std::sin(turn + phase), -3.0 + 2.0 * std::cos(turn + phase);
      }
      motions.push_back(motion);
    }
    const FrameMatrixD mean = mean_of(motions);
    const FrameMatrixD blend =
        blend_motions(motions, {}, kRate_hz, {.liveliness = 1.0, .expected_share = 0.0});
    const auto energy = [](const FrameMatrixD& motion) {
      return (motion.rowwise() - motion.colwise().mean()).squaredNorm();
    };
    EXPECT_LT(energy(mean), 0.8 * energy(motions[0]));
    EXPECT_NEAR(energy(blend), energy(motions[0]), 0.02 * energy(motions[0]));
    EXPECT_LT((blend.colwise().mean() - mean.colwise().mean()).norm(), 0.02);
    const FrameMatrixD half =
        blend_motions(motions, {}, kRate_hz, {.liveliness = 0.5, .expected_share = 0.0});
    EXPECT_NEAR(std::sqrt(energy(half)), 0.5 * (std::sqrt(energy(mean)) + std::sqrt(energy(blend))),
                0.01 * std::sqrt(energy(blend)));
  }
}

// Slow motion that all have in common in one coefficient and none in another: each is given back
// its own energy, and the first is left as it was.
TEST(Blend, EachSlowCoefficientGetsItsOwnEnergyBack) {
  std::vector<FrameMatrixD> motions;
  for (const double phase : {-0.9, 0.0, 0.9}) {
    FrameMatrixD motion(400, 2);
    for (Eigen::Index k = 0; k < motion.rows(); ++k) {
      const double turn = 2.0 * std::numbers::pi * static_cast<double>(k) / kRate_hz;
      motion.row(k) << 10.0 * std::sin(turn), std::sin(turn + phase);
    }
    motions.push_back(motion);
  }
  const FrameMatrixD blend =
      blend_motions(motions, {}, kRate_hz, {.liveliness = 1.0, .expected_share = 0.0});
  const auto energy = [](const FrameMatrixD& motion, Eigen::Index c) {
    return (motion.col(c).array() - motion.col(c).mean()).square().sum();
  };
  EXPECT_LT((blend.col(0) - motions[0].col(0)).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT(energy(mean_of(motions), 1), 0.7 * energy(motions[0], 1));
  EXPECT_NEAR(energy(blend, 1), energy(motions[0], 1), 0.02 * energy(motions[0], 1));
}

TEST(Blend, NoGainIsAboveTwo) {
  FrameMatrixD up = random_motion(4);
  const std::vector<FrameMatrixD> opposed = {up, -0.999 * up}; // nearly nothing is left
  const FrameMatrixD blend =
      blend_motions(opposed, {}, kRate_hz, {.liveliness = 1.0, .expected_share = 0.0});
  EXPECT_LT(blend.norm(), 2.01 * mean_of(opposed).norm());
}

} // namespace
} // namespace phonomime
