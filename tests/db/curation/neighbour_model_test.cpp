// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/neighbour_model.h"

#include "tests/db/curation/made_face.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::kFaceMarkers;
using test::made_face;
using test::made_motion;

FrameMatrix training() {
  return made_motion(2000, 1);
}

double length(const FrameMatrixD& residuals, Eigen::Index frame, int group) {
  return residuals.row(frame).segment<3>(3 * group).norm();
}

TEST(NeighbourModel, FramesItHasNotSeenAreWithinTheLimits) {
  const NeighbourModel model(training(), made_face(), 1);
  ASSERT_TRUE(model.known());
  const FrameMatrixD residuals = model.residuals(made_motion(1000, 1));
  for (Eigen::Index k = 0; k < residuals.rows(); ++k) {
    for (int group = 0; group < kFaceMarkers; ++group) {
      ASSERT_LT(length(residuals, k, group), model.limit(group)) << k << " " << group;
    }
  }
  // The noise is 0.05 mm a coordinate, on both sides of the prediction.
  for (int group = 0; group < kFaceMarkers; ++group) {
    EXPECT_GT(model.usual(group), 0.05);
    EXPECT_LT(model.usual(group), 0.2);
  }
}

TEST(NeighbourModel, ADisplacedMarkerIsOffByItsDisplacement) {
  const NeighbourModel model(training(), made_face(), 1);
  FrameMatrix frames = made_motion(50, 1);
  const FrameMatrixD before = model.residuals(frames);
  test::marker(frames, 20, 12) += Eigen::RowVector3f(3.0F, -4.0F, 12.0F);
  const FrameMatrixD after = model.residuals(frames);
  const Eigen::RowVector3d off = (after - before).row(20).segment<3>(36);
  EXPECT_LT((off - Eigen::RowVector3d(3.0, -4.0, 12.0)).norm(), 1e-3);
  EXPECT_LT((after - before).topRows(20).cwiseAbs().maxCoeff(), 1e-9);
}

// What take_off does is what the residuals are without the displacement.
TEST(NeighbourModel, TakingADisplacementOffUndoesIt) {
  const NeighbourModel model(training(), made_face(), 1);
  FrameMatrix frames = made_motion(5, 1);
  const FrameMatrixD before = model.residuals(frames);
  const Eigen::Vector3d by(2.0, 1.0, -5.0);
  test::marker(frames, 2, 7) += by.transpose().cast<float>();
  FrameMatrixD after = model.residuals(frames);
  EXPECT_GT((after - before).cwiseAbs().maxCoeff(), 1.0);
  model.take_off(7, by, &after(2, 0));
  EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(NeighbourModel, AFewContaminatedFramesDoNotBendIt) {
  FrameMatrix frames = training();
  for (Eigen::Index k = 0; k < frames.rows(); k += 20) { // 5 %
    test::marker(frames, k, 12) += Eigen::RowVector3f(10.0F, 0.0F, 0.0F);
    test::marker(frames, k, 13) += Eigen::RowVector3f(0.0F, 10.0F, 0.0F);
  }
  const NeighbourModel clean(training(), made_face(), 1), bent(frames, made_face(), 1);
  for (int group = 0; group < kFaceMarkers; ++group) {
    EXPECT_LT(bent.limit(group), 1.3 * clean.limit(group)) << group;
  }
}

// A lid moves with the other lid, which is far away, and with nothing that is near.
TEST(NeighbourModel, WhatMovesTogetherFarApartIsUnderstood) {
  FrameMatrix frames = training();
  const auto blink = [](FrameMatrix& some, Eigen::Index first) {
    for (Eigen::Index k = first; k < first + 12; ++k) {
      test::marker(some, k, 0) -= Eigen::RowVector3f(0.0F, 6.0F, 0.0F);
      test::marker(some, k, 24) -= Eigen::RowVector3f(0.0F, 6.0F, 0.0F);
    }
  };
  for (Eigen::Index first = 50; first < 1900; first += 200) {
    blink(frames, first);
  }
  const NeighbourModel model(frames, made_face(), 1);
  FrameMatrix unseen = made_motion(200, 1);
  blink(unseen, 100);
  const FrameMatrixD residuals = model.residuals(unseen);
  EXPECT_LT(length(residuals, 106, 0), model.limit(0));
  EXPECT_LT(length(residuals, 106, 24), model.limit(24));
  // One of them alone is not.
  test::marker(unseen, 150, 0) -= Eigen::RowVector3f(0.0F, 6.0F, 0.0F);
  EXPECT_GT(length(model.residuals(unseen), 150, 0), model.limit(0));
}

TEST(NeighbourModel, IsTheSameWithAnyNumberOfThreads) {
  const FrameMatrix frames = made_motion(300, 3);
  const NeighbourModel one(training(), made_face(), 1), two(training(), made_face(), 2);
  EXPECT_TRUE(one.residuals(frames) == two.residuals(frames));
  for (int group = 0; group < kFaceMarkers; ++group) {
    EXPECT_EQ(one.limit(group), two.limit(group));
  }
}

TEST(NeighbourModel, KnowsNothingOfTooLittle) {
  EXPECT_FALSE(NeighbourModel(made_motion(199, 1), made_face(), 1).known());
  EXPECT_TRUE(NeighbourModel(made_motion(200, 1), made_face(), 1).known());
  EXPECT_FALSE(NeighbourModel(FrameMatrix(0, 75), made_face(), 1).known());
  Layout alone;
  alone.groups = {{"only", {}}};
  EXPECT_FALSE(NeighbourModel(FrameMatrix::Zero(300, 3), alone, 1).known());
}

// Nothing moves, nothing can be learned, nothing is wrong.
TEST(NeighbourModel, StandsAFaceThatNeverMoves) {
  const NeighbourModel model(FrameMatrix::Ones(300, 75), made_face(), 1);
  EXPECT_LT(model.residuals(FrameMatrix::Ones(4, 75)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(model.limit(3), 0.5);
}

TEST(NeighbourModel, WeightsArePredictedFromThoseTheyMoveWith) {
  Layout layout;
  layout.kind = LayoutKind::weights;
  for (int i = 0; i < 12; ++i) {
    layout.groups.push_back({"w" + std::to_string(i), {}});
  }
  const FrameMatrix motion = made_motion(500, 4, 0.0);
  FrameMatrix weights = 0.1F * motion.leftCols(12);
  const NeighbourModel model(weights, layout, 1);
  EXPECT_LT(model.usual(5), 0.05);
  weights(100, 5) += 0.5F;
  EXPECT_GT(std::abs(model.residuals(weights)(100, 5)), model.limit(5));
}

} // namespace
} // namespace phonomime
