// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/select_keyshapes.h"

#include "db/types/errors.h"
#include "synth/retarget/keyshapes/cluster_frames.h"
#include "synth/retarget/keyshapes/convex_hull.h"

#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

FrameMatrixD cloud(std::uint64_t seed, Eigen::Index count, Eigen::Index axes) {
  std::mt19937_64 draw(seed);
  std::normal_distribution<double> number;
  FrameMatrixD points = FrameMatrixD::NullaryExpr(count, axes, [&] { return number(draw); });
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    points.col(axis) *= 10.0 / static_cast<double>(1 + axis);
  }
  return points;
}

std::vector<Eigen::Index> frames_of(const KeyshapeSelection& selection) {
  std::vector<Eigen::Index> frames;
  for (const Keyshape& keyshape : selection.chosen) {
    frames.push_back(keyshape.frame);
  }
  return frames;
}

TEST(SelectKeyshapes, TakesTheExtremaOfAxisAfterAxis) {
  const FrameMatrixD points = cloud(1, 500, 6);
  const KeyshapeSelection selection = select_keyshapes(points, {.count = 8, .similar = 0.0});
  ASSERT_EQ(selection.chosen.size(), 8u);
  int taken = 0;
  std::set<Eigen::Index> seen;
  for (const Keyshape& keyshape : selection.chosen) {
    const auto column = points.col(keyshape.axis);
    EXPECT_EQ(points(keyshape.frame, keyshape.axis),
              keyshape.largest ? column.maxCoeff() : column.minCoeff());
    EXPECT_GE(keyshape.axis, taken / 2);
    EXPECT_TRUE(seen.insert(keyshape.frame).second);
    ++taken;
  }
  EXPECT_TRUE(selection.chosen[0].largest && !selection.chosen[1].largest);
}

TEST(SelectKeyshapes, LeavesOutExtremaLikeThoseOfMoreDominantAxes) {
  // Axis 0: frames 0 and 1. Axis 1: frame 0 again, and frame 2, a hair from frame 1. Axis 2: 3, 4.
  FrameMatrixD points(5, 3);
  points << 10, 5, 0.0, //
      -10, -4.9, 0.0,   //
      -9.9, -5, 0.0,    //
      0, 0, 4,          //
      0, 0, -4;
  const KeyshapeSelection selection = select_keyshapes(points, {.count = 4, .similar = 0.1});
  EXPECT_EQ(frames_of(selection), (std::vector<Eigen::Index>{0, 1, 3, 4}));
  ASSERT_EQ(selection.left_out.size(), 2u);
  EXPECT_EQ(selection.left_out[0].keyshape.frame, 0);
  EXPECT_EQ(selection.left_out[0].distance, 0.0);
  EXPECT_EQ(selection.left_out[1].keyshape.frame, 2);
  EXPECT_EQ(selection.left_out[1].kept, 1u);
  EXPECT_NEAR(selection.left_out[1].distance, std::hypot(0.1, 0.1), 1e-12);
  EXPECT_EQ(frames_of(select_keyshapes(points, {.count = 4, .similar = 0.0})),
            (std::vector<Eigen::Index>{0, 1, 2, 3}));
}

TEST(SelectKeyshapes, FewerExtremaAreTheFirstOfMore) {
  const FrameMatrixD points = cloud(2, 400, 10);
  const std::vector<Eigen::Index> all = frames_of(select_keyshapes(points, {.count = 15}));
  for (int count = 1; count < 15; ++count) {
    EXPECT_EQ(frames_of(select_keyshapes(points, {.count = count})),
              std::vector<Eigen::Index>(all.begin(), all.begin() + count));
  }
}

// A point is a corner where some other point makes a line that has all points on one side of it,
// and no two points hold it between them.
bool is_corner(const FrameMatrixD& points, Eigen::Index i) {
  for (Eigen::Index j = 0; j < points.rows(); ++j) {
    if (points.row(j) == points.row(i)) {
      continue;
    }
    bool one_side = true;
    bool end = true;
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      const Eigen::RowVector2d along = points.row(j) - points.row(i);
      const Eigen::RowVector2d to = points.row(k) - points.row(i);
      const double turn = along[0] * to[1] - along[1] * to[0];
      one_side &= turn >= 0.0;
      end &= turn != 0.0 || along.dot(to) >= 0.0;
    }
    if (one_side && end) {
      return true;
    }
  }
  return false;
}

TEST(SelectKeyshapes, HullHasTheCornersThatTryingEveryLineFinds) {
  FrameMatrixD points = cloud(3, 120, 2);
  // Whole numbers, so that some lie on one line and some at one place.
  points = points.array().round();
  std::set<std::pair<double, double>> expected;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (is_corner(points, i)) {
      expected.insert({points(i, 0), points(i, 1)});
    }
  }
  const std::vector<Eigen::Index> hull = convex_hull(points);
  std::set<std::pair<double, double>> found;
  for (const Eigen::Index i : hull) {
    EXPECT_TRUE(found.insert({points(i, 0), points(i, 1)}).second);
    for (Eigen::Index before = 0; before < i; ++before) {
      EXPECT_NE(points.row(before), points.row(i)) << "not the first at its place";
    }
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(points(hull.front(), 0), points.col(0).minCoeff());
}

TEST(SelectKeyshapes, ClustersAreFoundWhereTheyAre) {
  std::mt19937_64 draw(4);
  std::normal_distribution<double> number;
  FrameMatrixD points(300, 2);
  for (Eigen::Index i = 0; i < 300; ++i) { // three heaps of 150, 100 and 50 frames
    const double heap = i < 150 ? 0.0 : i < 250 ? 20.0 : -35.0;
    points.row(i) << heap + number(draw), 0.5 * heap + number(draw);
  }
  const std::vector<Eigen::Index> frames = cluster_frames(points, 3, 9);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_TRUE(frames[0] < 150 && frames[1] >= 150 && frames[1] < 250 && frames[2] >= 250);
  // The frame nearest the mean of its heap.
  const Eigen::RowVector2d centre = points.topRows(150).colwise().mean();
  Eigen::Index nearest = 0;
  (points.topRows(150).rowwise() - centre).rowwise().norm().minCoeff(&nearest);
  EXPECT_EQ(frames[0], nearest);
  EXPECT_EQ(cluster_frames(points, 3, 9), frames);
  EXPECT_EQ(cluster_frames(FrameMatrixD::Ones(10, 2), 4, 1).size(), 1u);
}

TEST(SelectKeyshapes, RefusesOptionsOutOfRange) {
  EXPECT_THROW(KeyshapeOptions{.count = 0}.validate(), UsageError);
  EXPECT_THROW(KeyshapeOptions{.similar = -1.0}.validate(), UsageError);
  EXPECT_THROW(KeyshapeOptions{.cluster_dimensions = 0}.validate(), UsageError);
  EXPECT_TRUE(select_keyshapes(FrameMatrixD(0, 3), {}).chosen.empty());
}

} // namespace
} // namespace phonomime
