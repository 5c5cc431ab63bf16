// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/isomap.h"
#include "tests/isomap/point_sets.h"
#include "tests/support/expect_error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Root mean square distance of a's points from b's after the best similarity, over b's spread.
double similarity_misfit(const MapPlaces& a, const MapPlaces& b) {
  const auto spread = [](const MapPlaces& places) {
    return (places.rowwise() - places.colwise().mean()).norm();
  };
  return test::misfit(a * (spread(b) / spread(a)), b);
}

TEST(Isomap, UnrollsASwissRoll) {
  std::mt19937 random(41);
  const test::SwissRoll roll = test::swiss_roll(random, 2000);
  const ClusterMaps maps = build_maps(roll.points, {});
  EXPECT_EQ(maps.component_sizes, std::vector<std::int32_t>{2000});
  EXPECT_EQ(maps.landmarks, 0);
  EXPECT_LT(maps.isomap_residual_variance, 0.005);
  EXPECT_GT(maps.pca_residual_variance, 0.3);
  EXPECT_LT(similarity_misfit(maps.isomap, roll.sheet), 0.2);
}

TEST(Isomap, UnrollsASwissRollByLandmarks) {
  std::mt19937 random(42);
  const test::SwissRoll roll = test::swiss_roll(random, 4000);
  const ClusterMaps exact = build_maps(roll.points, {});
  const ClusterMaps maps = build_maps(roll.points, {.largest_exact = 1000, .landmarks = 300});
  EXPECT_EQ(maps.landmarks, 300);
  EXPECT_NEAR(maps.isomap_residual_variance, exact.isomap_residual_variance, 0.005);
  EXPECT_LT(test::misfit(maps.isomap, exact.isomap), 0.1);
}

TEST(Isomap, LandmarksComeNearTheExactMapOfTrajectories) {
  std::mt19937 random(43);
  const FrameMatrix points = test::trajectory_points(random, 200, 15, 25);
  const ClusterMaps exact = build_maps(points, {});
  const ClusterMaps maps = build_maps(points, {.largest_exact = 1000, .landmarks = 300});
  EXPECT_NEAR(maps.isomap_residual_variance, exact.isomap_residual_variance, 0.02);
  EXPECT_NEAR(maps.pca_residual_variance, exact.pca_residual_variance, 0.02);
  EXPECT_EQ(maps.pca, exact.pca);
}

TEST(Isomap, OfAllPointsAsLandmarksIsTheExactMap) {
  std::mt19937 random(44);
  const FrameMatrix points = test::trajectory_points(random, 40, 10, 25);
  const ClusterMaps exact = build_maps(points, {});
  const ClusterMaps maps = build_maps(points, {.largest_exact = 1, .landmarks = 400});
  EXPECT_EQ(maps.landmarks, 400);
  EXPECT_LT((maps.isomap - exact.isomap).norm(), 1e-6 * exact.isomap.norm());
}

TEST(Isomap, OfAPlanarPatchIsThePatch) {
  // Geodesics through a graph are a little long, so that a patch comes out a little larger.
  std::mt19937 random(45);
  MapPlaces patch = test::uniform_points(random, 3000, 2).cast<double>();
  patch.col(0) *= 2.0;
  const ClusterMaps maps = build_maps(test::lay_into_space(random, patch, 25), {});
  EXPECT_LT(maps.isomap_residual_variance, 0.001);
  EXPECT_LT(similarity_misfit(maps.isomap, patch), 0.1);
  EXPECT_LT(test::misfit(maps.pca, patch), 1e-5);
  EXPECT_GT(maps.isomap.norm(), maps.pca.norm());
  EXPECT_LT(maps.isomap.norm(), 1.1 * maps.pca.norm());
}

TEST(Isomap, IsTheSameForOneAndTwoThreads) {
  std::mt19937 random(46);
  const FrameMatrix points = test::trajectory_points(random, 80, 12, 25);
  for (const int largest_exact : {5000, 100}) {
    IsomapOptions options = {.largest_exact = largest_exact, .landmarks = 200, .threads = 1};
    const ClusterMaps one = build_maps(points, options);
    options.threads = 2;
    const ClusterMaps two = build_maps(points, options);
    EXPECT_EQ(one.isomap, two.isomap);
    EXPECT_EQ(one.pca, two.pca);
    EXPECT_EQ(one.isomap_residual_variance, two.isomap_residual_variance);
    EXPECT_EQ(one.pca_residual_variance, two.pca_residual_variance);
  }
}

TEST(Isomap, AxesDoNotFlip) {
  // In another order of the points the eigenvectors begin elsewhere; the axes must not.
  std::mt19937 random(47);
  const FrameMatrix points = test::trajectory_points(random, 40, 10, 25);
  const FrameMatrix reversed = points.colwise().reverse();
  const ClusterMaps maps = build_maps(points, {});
  const ClusterMaps again = build_maps(reversed, {});
  EXPECT_LT((maps.isomap - again.isomap.colwise().reverse()).norm(), 1e-6 * maps.isomap.norm());
  EXPECT_LT((maps.pca - again.pca.colwise().reverse()).norm(), 1e-6 * maps.pca.norm());
  // Along each axis the dimension that goes with it most increases.
  const Eigen::MatrixXd centred =
      points.cast<double>().rowwise() - points.cast<double>().colwise().mean();
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const Eigen::VectorXd covariance = centred.transpose() * maps.isomap.col(axis);
    Eigen::Index strongest = 0;
    covariance.cwiseAbs().maxCoeff(&strongest);
    EXPECT_GT(covariance[strongest], 0.0);
  }
}

TEST(Isomap, OfAClusterInParts) {
  std::mt19937 random(48);
  FrameMatrix points = test::uniform_points(random, 300, 5);
  points.middleRows(200, 70).col(0).array() += 50.0F;
  points.bottomRows(30).col(1).array() += 80.0F;
  const ClusterMaps joined = build_maps(points, {});
  EXPECT_EQ(joined.component_sizes, (std::vector<std::int32_t>{200, 70, 30}));
  EXPECT_EQ(joined.joined.size(), 2U);
  EXPECT_EQ(joined.kept.size(), 300U);
  EXPECT_TRUE(joined.isomap.allFinite());
  EXPECT_GT((joined.isomap.row(0) - joined.isomap.row(250)).norm(), 40.0);

  const ClusterMaps largest = build_maps(points, {.disconnected = DisconnectedParts::keep_largest});
  EXPECT_EQ(largest.component_sizes, joined.component_sizes);
  EXPECT_TRUE(largest.joined.empty());
  std::vector<std::int32_t> first(200);
  std::iota(first.begin(), first.end(), 0);
  EXPECT_EQ(largest.kept, first);
  EXPECT_EQ(largest.isomap, build_maps(points.topRows(200), {}).isomap);
  EXPECT_EQ(largest.pca, build_maps(points.topRows(200), {}).pca);
}

TEST(Isomap, SurvivesAFarOutlierAndNamesIt) {
  std::mt19937 random(49);
  FrameMatrix points = test::uniform_points(random, 400, 25);
  points.row(123).setConstant(1000.0F);
  const ClusterMaps maps = build_maps(points, {});
  EXPECT_EQ(maps.far_points, std::vector<std::int32_t>{123});
  EXPECT_TRUE(maps.isomap.allFinite());
  EXPECT_GT(std::abs(maps.isomap(123, 0) - maps.isomap(0, 0)), 4000.0);
  EXPECT_TRUE(build_maps(test::uniform_points(random, 400, 25), {}).far_points.empty());
}

TEST(Isomap, SurvivesDuplicates) {
  std::mt19937 random(50);
  FrameMatrix points = test::uniform_points(random, 300, 25);
  for (Eigen::Index i = 100; i < 140; ++i) { // more alike than a point has neighbours
    points.row(i) = points.row(100);
  }
  const ClusterMaps maps = build_maps(points, {});
  EXPECT_TRUE(maps.isomap.allFinite());
  for (Eigen::Index i = 100; i < 140; ++i) {
    EXPECT_LT((maps.isomap.row(i) - maps.isomap.row(100)).norm(), 1e-9);
  }
  const auto in_all = std::accumulate(maps.component_sizes.begin(), maps.component_sizes.end(), 0);
  EXPECT_EQ(in_all, 300);
}

TEST(Isomap, OfFewFramesAndOfFramesThatAreAllAlike) {
  std::mt19937 random(51);
  for (const int count : {0, 1, 2, 3, 5, 12, 13, 14}) {
    SCOPED_TRACE(count);
    const FrameMatrix points = test::uniform_points(random, count, 25);
    for (const int largest_exact : {5000, 4}) {
      const ClusterMaps maps = build_maps(points, {.largest_exact = largest_exact, .landmarks = 3});
      EXPECT_EQ(maps.isomap.rows(), count);
      EXPECT_TRUE(maps.isomap.allFinite());
      EXPECT_GE(maps.isomap_residual_variance, 0.0);
      EXPECT_LE(maps.isomap_residual_variance, 1.0);
      EXPECT_EQ(maps.neighbours, std::clamp(count - 1, 0, 12));
    }
    if (count == 2) {
      const ClusterMaps maps = build_maps(points, {});
      EXPECT_NEAR(std::abs(maps.isomap(1, 0) - maps.isomap(0, 0)),
                  (points.row(1) - points.row(0)).norm(), 1e-6);
      EXPECT_EQ(maps.isomap(0, 1), 0.0);
    }
  }
  for (const int largest_exact : {5000, 20}) {
    const ClusterMaps maps = build_maps(FrameMatrix::Constant(60, 25, 3.5F),
                                        {.largest_exact = largest_exact, .landmarks = 10});
    EXPECT_EQ(maps.isomap, (MapPlaces(MapPlaces::Zero(60, 2))));
    EXPECT_EQ(maps.pca, (MapPlaces(MapPlaces::Zero(60, 2))));
    EXPECT_EQ(maps.isomap_residual_variance, 0.0);
    EXPECT_TRUE(maps.far_points.empty());
  }
}

TEST(Isomap, OfOneSentenceIsItsTrajectory) {
  FrameMatrix points(20, 25); // one node, moving steadily along a line
  for (Eigen::Index i = 0; i < 20; ++i) {
    points.row(i).setConstant(0.2F * static_cast<float>(i));
  }
  const ClusterMaps maps = build_maps(points, {});
  for (Eigen::Index i = 1; i < 20; ++i) {
    EXPECT_NEAR(maps.isomap(i, 0) - maps.isomap(i - 1, 0), 1.0, 1e-5);
    EXPECT_NEAR(maps.isomap(i, 1), 0.0, 1e-5);
  }
}

TEST(Isomap, OfPointsInOneDimensionIsALine) {
  std::mt19937 random(52);
  const ClusterMaps maps = build_maps(test::uniform_points(random, 100, 1), {});
  EXPECT_LT(maps.isomap.col(1).norm(), 1e-6 * maps.isomap.col(0).norm());
  EXPECT_EQ(maps.pca.col(1).norm(), 0.0);
}

TEST(Isomap, RefusesWhatItCannotUse) {
  const FrameMatrix points = FrameMatrix::Zero(3, 2);
  test::expect_error([&] { build_maps(points, {.neighbours = 0}); },
                     "neighbours is out of range (expected at least 1, got 0)");
  test::expect_error([&] { build_maps(points, {.landmarks = 2}); }, "landmarks");
  test::expect_error([&] { build_maps(points, {.largest_exact = 0}); }, "largest_exact");
  test::expect_error([&] { build_maps(points, {.threads = -1}); }, "threads");
  FrameMatrix not_finite = points;
  not_finite(1, 1) = std::nanf("");
  EXPECT_THROW(build_maps(not_finite, {}), InternalError);
}

TEST(Isomap, TellsWhereItIsAndStops) {
  std::mt19937 random(53);
  const FrameMatrix points = test::uniform_points(random, 100, 5);
  std::vector<std::string> stages;
  build_maps(points, {}, {.report = [&](std::string_view stage, std::int64_t, std::int64_t) {
               stages.emplace_back(stage);
             }});
  EXPECT_EQ(stages.front(), "neighbours");
  EXPECT_EQ(stages.back(), "geodesics");
  const std::atomic<bool> stop = true;
  EXPECT_THROW(build_maps(points, {}, {.report = {}, .stop = &stop}), Interrupted);
}

} // namespace
} // namespace phonomime
