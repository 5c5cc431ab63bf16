// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/gaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace phonomime {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

double cubic(double t) {
  return 2.0 - 0.7 * t + 0.3 * t * t - 0.02 * t * t * t;
}

FrameMatrixD cubic_motion(Eigen::Index frames) {
  FrameMatrixD motion(frames, 6);
  for (Eigen::Index k = 0; k < frames; ++k) {
    for (Eigen::Index c = 0; c < 6; ++c) {
      motion(k, c) = cubic(static_cast<double>(k)) * static_cast<double>(c + 1);
    }
  }
  return motion;
}

TEST(Gaps, ShortOnesInsideAreFilledExactlyWhereTheMotionIsCubic) {
  const FrameMatrixD truth = cubic_motion(20);
  FrameMatrixD motion = truth;
  motion(5, 1) = kMissing; // one coordinate: the whole marker is missing
  motion.block(10, 3, 3, 3).setConstant(kMissing);
  const GapFill filled = fill_gaps(motion, 3, 100.0, 0.03);
  EXPECT_LT((filled.frames - truth).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(filled.gaps,
            (std::vector<Gap>{{0, 5, 1, GapAction::filled}, {1, 10, 3, GapAction::filled}}));
  EXPECT_EQ(filled.frame_has_gap, std::vector<std::uint8_t>(20, 0));
}

TEST(Gaps, LongerThanTheLimitAreMarkedAndBridged) {
  FrameMatrixD motion = cubic_motion(20);
  motion.block(10, 0, 4, 3).setConstant(kMissing);
  const GapFill filled = fill_gaps(motion, 3, 100.0, 0.03);
  ASSERT_EQ(filled.gaps.size(), 1u);
  EXPECT_EQ(filled.gaps[0].action, GapAction::marked);
  for (Eigen::Index k = 0; k < 20; ++k) {
    EXPECT_EQ(filled.frame_has_gap[static_cast<std::size_t>(k)], k >= 10 && k < 14) << k;
  }
  EXPECT_NEAR(filled.frames(11, 0), 0.6 * motion(9, 0) + 0.4 * motion(14, 0), 1e-12);
}

TEST(Gaps, AtTheEndsTheNearestValueIsHeld) {
  FrameMatrixD motion = cubic_motion(12);
  motion.block(0, 0, 2, 3).setConstant(kMissing);
  motion.block(6, 3, 6, 3).setConstant(kMissing);
  const GapFill filled = fill_gaps(motion, 3, 100.0, 0.03);
  EXPECT_EQ(filled.gaps,
            (std::vector<Gap>{{0, 0, 2, GapAction::held}, {1, 6, 6, GapAction::marked}}));
  EXPECT_EQ(filled.frames(0, 0), motion(2, 0));
  EXPECT_EQ(filled.frames(11, 4), motion(5, 4));
}

TEST(Gaps, EveryMissingValueIsInExactlyOneGapAndNothingElseChanges) {
  std::mt19937 random(11);
  for (int round = 0; round < 100; ++round) {
    FrameMatrixD motion = cubic_motion(30);
    std::int64_t missing = 0;
    for (Eigen::Index k = 0; k < 30; ++k) {
      for (int group = 0; group < 2; ++group) {
        if (random() % 3 == 0) {
          motion.row(k).segment(3 * group, 3).setConstant(kMissing);
          ++missing;
        }
      }
    }
    if (!groups_missing_throughout(motion, 3).empty()) {
      continue;
    }
    const GapFill filled = fill_gaps(motion, 3, 100.0, 0.02);
    ASSERT_TRUE(filled.frames.allFinite());
    std::int64_t counted = 0;
    for (const Gap& gap : filled.gaps) {
      counted += gap.frame_count;
      EXPECT_EQ(gap.action == GapAction::marked, gap.frame_count > 2);
    }
    EXPECT_EQ(counted, missing);
    for (Eigen::Index k = 0; k < 30; ++k) {
      for (Eigen::Index c = 0; c < 6; ++c) {
        EXPECT_TRUE(std::isnan(motion(k, c)) || motion(k, c) == filled.frames(k, c));
      }
    }
  }
}

TEST(Gaps, AGroupMissingThroughoutIsNamed) {
  FrameMatrixD motion = cubic_motion(5);
  motion.block(0, 3, 5, 1).setConstant(kMissing);
  EXPECT_EQ(groups_missing_throughout(motion, 3), std::vector<int>{1});
}

} // namespace
} // namespace phonomime
