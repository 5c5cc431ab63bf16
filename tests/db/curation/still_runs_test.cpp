// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/still_runs.h"

#include "tests/db/curation/made_face.h"

#include <limits>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::kFaceRate_hz;
using test::made_face;
using test::made_motion;

FrameMatrixD motion() {
  return made_motion(300, 5).cast<double>();
}

void freeze(FrameMatrixD& frames, int group, Eigen::Index first, Eigen::Index count) {
  for (Eigen::Index k = first; k < first + count; ++k) {
    frames.row(k).segment<3>(3 * group) = frames.row(first).segment<3>(3 * group);
  }
}

std::vector<StillRun> find(const FrameMatrixD& frames, const StillLimits& limits = {}) {
  return still_runs(frames, made_face(), kFaceRate_hz, limits);
}

TEST(StillRuns, AMarkerThatKeepsItsPlaceForATenthOfASecondIsFrozen) {
  FrameMatrixD frames = motion();
  EXPECT_TRUE(find(frames).empty());
  freeze(frames, 7, 100, 10);
  freeze(frames, 9, 200, 9); // a frame too short
  const std::vector<StillRun> runs = find(frames);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].group, 7);
  EXPECT_EQ(runs[0].first_frame, 100);
  EXPECT_EQ(runs[0].frame_count, 10);
  EXPECT_GT(runs[0].others, 0.3);
  EXPECT_DOUBLE_EQ(runs[0].score(kFaceRate_hz), 1.0);
}

TEST(StillRuns, NeighboursThatAreFrozenTooDoNotHideIt) {
  FrameMatrixD frames = motion();
  for (const int group : {6, 7, 8, 11, 12, 13, 16, 17, 18}) {
    freeze(frames, group, 100, 20);
  }
  EXPECT_EQ(find(frames).size(), 9u);
}

TEST(StillRuns, WhileNothingMovesNothingIsFrozenButAFaceThatStops) {
  FrameMatrixD frames = motion();
  for (int group = 0; group < test::kFaceMarkers; ++group) {
    freeze(frames, group, 100, 15);
  }
  EXPECT_TRUE(find(frames).empty());
  for (int group = 0; group < test::kFaceMarkers; ++group) {
    freeze(frames, group, 100, 20);
  }
  const std::vector<StillRun> runs = find(frames);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].group, -1);
  EXPECT_EQ(runs[0].frame_count, 20);
}

TEST(StillRuns, WhatNeverMovesIsAtRestByNature) {
  FrameMatrixD frames = motion();
  freeze(frames, 2, 0, 280);
  EXPECT_TRUE(find(frames).empty());
  frames = motion();
  freeze(frames, 2, 0, 200); // but two thirds of a sentence are not nature
  EXPECT_EQ(find(frames).size(), 1u);
}

TEST(StillRuns, AMissingFrameEndsARunAndNeverBeginsOne) {
  FrameMatrixD frames = motion();
  freeze(frames, 7, 100, 19);
  frames(109, 21) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(find(frames).empty()); // 9 frames on either side
  for (Eigen::Index k = 150; k < 190; ++k) {
    frames.row(k).segment<3>(9).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  EXPECT_TRUE(find(frames).empty());
}

TEST(StillRuns, ToleranceIsAboutTheRunsFirstFrame) {
  FrameMatrixD frames = motion();
  for (Eigen::Index k = 100; k < 130; ++k) { // creeps: never far from the frame before
    frames.row(k).segment<3>(21) = frames.row(100).segment<3>(21);
    frames(k, 21) += 0.0004 * static_cast<double>(k - 100);
  }
  EXPECT_TRUE(find(frames, {.tolerance = 1e-3, .least_s = 0.08}).empty());
  freeze(frames, 7, 100, 8);
  EXPECT_EQ(find(frames, {.tolerance = 1e-3, .least_s = 0.08}).size(), 1u);
}

TEST(StillRuns, WeightsAreStillOnlyAllTogether) {
  Layout layout;
  layout.kind = LayoutKind::weights;
  layout.groups.assign(4, {"w", {}});
  FrameMatrixD frames = motion().leftCols(4);
  frames.col(2).setZero();
  EXPECT_TRUE(still_runs(frames, layout, kFaceRate_hz, {}).empty());
  for (Eigen::Index k = 50; k < 70; ++k) {
    frames.row(k) = frames.row(50);
  }
  ASSERT_EQ(still_runs(frames, layout, kFaceRate_hz, {}).size(), 1u);
  EXPECT_EQ(still_runs(frames, layout, kFaceRate_hz, {})[0].group, -1);
}

} // namespace
} // namespace phonomime
