// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/displaced_groups.h"

#include "db/types/suspect_mark.h"
#include "tests/db/curation/made_face.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::kFaceRate_hz;
using test::made_face;
using test::made_motion;
using test::marker;

const NeighbourModel& model() {
  static const NeighbourModel learned(made_motion(2000, 1), made_face(), 1);
  return learned;
}

std::vector<DisplacedRun> find(const FrameMatrix& frames, std::vector<std::uint8_t> gaps = {}) {
  gaps.resize(static_cast<std::size_t>(frames.rows()), 0);
  return displaced_runs(model(), frames, gaps, made_face(), kFaceRate_hz);
}

TEST(DisplacedRuns, ThereIsNoneInCleanMotion) {
  EXPECT_TRUE(find(made_motion(2000, 1)).empty());
}

TEST(DisplacedRuns, AJumpIsFoundWhereItIsAndNobodyElseIsBlamed) {
  FrameMatrix frames = made_motion(300, 1);
  for (Eigen::Index k = 100; k < 107; ++k) {
    marker(frames, k, 12) += Eigen::RowVector3f(4.0F, 3.0F, 0.0F);
  }
  const std::vector<DisplacedRun> runs = find(frames);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].reason, suspect::kJump);
  EXPECT_EQ(runs[0].group, 12);
  EXPECT_EQ(runs[0].first_frame, 100);
  EXPECT_EQ(runs[0].frame_count, 7);
  EXPECT_EQ(runs[0].size.size(), 7u);
  EXPECT_NEAR(runs[0].peak, 5.0, 0.7);
  EXPECT_LE(runs[0].change_s, 0.02);
}

TEST(DisplacedRuns, ASingleFrameIsEnough) {
  FrameMatrix frames = made_motion(300, 1);
  marker(frames, 0, 3)[2] += 5.0F; // the first of all
  marker(frames, 299, 20)[0] -= 5.0F;
  const std::vector<DisplacedRun> runs = find(frames);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].group, 3);
  EXPECT_EQ(runs[0].frame_count, 1);
  EXPECT_EQ(runs[1].group, 20);
}

TEST(DisplacedRuns, SwappedMarkersAreTold) {
  for (const auto& [a, b] : {std::pair(11, 12), std::pair(0, 24), std::pair(7, 17)}) {
    FrameMatrix frames = made_motion(300, 1);
    for (Eigen::Index k = 50; k < 90; ++k) {
      const Eigen::RowVector3f kept = marker(frames, k, a);
      marker(frames, k, a) = marker(frames, k, b);
      marker(frames, k, b) = kept;
    }
    const std::vector<DisplacedRun> runs = find(frames);
    const auto swapped = [&](int one, int other) {
      return std::ranges::any_of(runs, [&](const DisplacedRun& run) {
        return run.reason == suspect::kSwapped && run.group == one && run.partner == other &&
               run.first_frame == 50 && run.frame_count == 40;
      });
    };
    EXPECT_TRUE(swapped(a, b)) << a << " " << b;
    EXPECT_TRUE(swapped(b, a)) << a << " " << b;
  }
}

TEST(DisplacedRuns, WhatIsSwappedThroughoutIsFoundToo) {
  FrameMatrix frames = made_motion(300, 1);
  const FrameMatrix kept = frames.middleCols(3 * 6, 3);
  frames.middleCols(3 * 6, 3) = frames.middleCols(3 * 18, 3).eval();
  frames.middleCols(3 * 18, 3) = kept;
  const std::vector<DisplacedRun> runs = find(frames);
  ASSERT_FALSE(runs.empty());
  EXPECT_EQ(runs[0].reason, suspect::kSwapped);
  EXPECT_EQ(runs[0].frame_count, 300);
}

TEST(DisplacedRuns, ASlowOneIsADriftAndALastingOneADisagreement) {
  FrameMatrix frames = made_motion(300, 1);
  for (Eigen::Index k = 100; k < 160; ++k) { // slides by 8 mm, then snaps back
    marker(frames, k, 8)[0] += 8.0F * static_cast<float>(k - 99) / 60.0F;
  }
  for (Eigen::Index k = 0; k < 300; ++k) {
    marker(frames, k, 21)[1] += 4.0F;
  }
  const std::vector<DisplacedRun> runs = find(frames);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].reason, suspect::kNeighbours);
  EXPECT_EQ(runs[0].group, 21);
  EXPECT_EQ(runs[0].frame_count, 300);
  EXPECT_EQ(runs[1].reason, suspect::kDrift);
  EXPECT_EQ(runs[1].group, 8);
  EXPECT_GT(runs[1].first_frame, 99);
  EXPECT_LT(runs[1].first_frame, 115);
  EXPECT_EQ(runs[1].first_frame + runs[1].frame_count, 160);
}

TEST(DisplacedRuns, FramesWithGapsArePassedOver) {
  FrameMatrix frames = made_motion(300, 1);
  std::vector<std::uint8_t> gaps(300, 0);
  for (Eigen::Index k = 100; k < 120; ++k) {
    marker(frames, k, 12).setZero();
    gaps[static_cast<std::size_t>(k)] = 1;
  }
  EXPECT_TRUE(find(frames, gaps).empty());
  EXPECT_FALSE(find(frames).empty());
}

} // namespace
} // namespace phonomime
