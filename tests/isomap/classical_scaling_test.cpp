// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/classical_scaling.h"
#include "isomap/residual_variance.h"
#include "tests/isomap/point_sets.h"

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

template <typename Points>
DistanceMatrix distances_between(const Points& points) {
  DistanceMatrix distances(points.rows(), points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (Eigen::Index j = 0; j < points.rows(); ++j) {
      distances(i, j) = (points.row(i) - points.row(j)).template cast<double>().norm();
    }
  }
  return distances;
}

MapPlaces random_places(std::mt19937& random, int count, double width, double height) {
  MapPlaces places = test::uniform_points(random, count, 2).cast<double>();
  places.col(0) *= width;
  places.col(1) *= height;
  return places;
}

TEST(ClassicalScaling, RecoversPlacesFromTheirDistances) {
  std::mt19937 random(31);
  for (const int count : {3, 10, 40, 41, 500}) {
    SCOPED_TRACE(count);
    const MapPlaces places = random_places(random, count, 3.0, 2.0);
    const DistanceMatrix distances = distances_between(places);
    const ScaledPlaces scaled = classical_scaling(distances, 1);
    EXPECT_LT(test::misfit(scaled.places, places), 1e-7);
    EXPECT_LT(scaled.places.colwise().mean().norm(), 1e-9);
    EXPECT_EQ(scaled.places, classical_scaling(distances, 2).places);
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(scaled.places.col(axis).squaredNorm(),
                  scaled.eigenvalues[static_cast<std::size_t>(axis)], 1e-6);
    }
  }
}

TEST(ClassicalScaling, EqualsTheDenseEigenvectorsOfDistancesThatNoPlaneHas) {
  std::mt19937 random(32);
  const FrameMatrix points = test::trajectory_points(random, 30, 10, 25);
  DistanceMatrix distances = distances_between(points).array().pow(0.8); // not Euclidean any more
  const Eigen::Index n = distances.rows();
  const Eigen::MatrixXd centre = Eigen::MatrixXd::Identity(n, n) -
                                 Eigen::MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));
  const Eigen::MatrixXd b = -0.5 * centre * distances.array().square().matrix() * centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(b);
  const ScaledPlaces scaled = classical_scaling(distances, 1);
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const double value = solver.eigenvalues()[n - 1 - axis];
    EXPECT_NEAR(scaled.eigenvalues[static_cast<std::size_t>(axis)], value, 1e-8 * value);
    const Eigen::VectorXd expected = solver.eigenvectors().col(n - 1 - axis) * std::sqrt(value);
    const double sign = expected.dot(scaled.places.col(axis)) < 0.0 ? -1.0 : 1.0;
    EXPECT_LT((sign * scaled.places.col(axis) - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(ClassicalScaling, OfPointsOnALineIsALine) {
  for (const int count : {2, 5, 300}) {
    SCOPED_TRACE(count);
    MapPlaces places = MapPlaces::Zero(count, 2);
    for (Eigen::Index i = 0; i < count; ++i) {
      places(i, 0) = 0.25 * static_cast<double>((i * 7) % count);
    }
    const ScaledPlaces scaled = classical_scaling(distances_between(places), 1);
    EXPECT_LT(test::misfit(scaled.places, places), 1e-6);
    EXPECT_EQ(scaled.places.col(1), Eigen::VectorXd::Zero(count));
    EXPECT_EQ(scaled.eigenvalues[1], 0.0);
  }
}

TEST(ClassicalScaling, OfNothingAndOfPointsThatAreAllAlike) {
  for (const int count : {0, 1, 2, 100}) {
    SCOPED_TRACE(count);
    const ScaledPlaces scaled = classical_scaling(DistanceMatrix::Zero(count, count), 1);
    EXPECT_EQ(scaled.places, (MapPlaces(MapPlaces::Zero(count, 2))));
  }
}

TEST(ClassicalScaling, OfACircleWhoseEigenvaluesAreEqual) {
  MapPlaces circle(360, 2);
  for (Eigen::Index i = 0; i < 360; ++i) {
    circle.row(i) << std::cos(static_cast<double>(i) * 0.0174532925199433),
        std::sin(static_cast<double>(i) * 0.0174532925199433);
  }
  EXPECT_LT(test::misfit(classical_scaling(distances_between(circle), 1).places, circle), 1e-6);
}

TEST(ResidualVariance, IsOneMinusTheSquaredCorrelation) {
  std::mt19937 random(33);
  const MapPlaces places = random_places(random, 50, 2.0, 1.0);
  const DistanceMatrix all = distances_between(test::uniform_points(random, 50, 3));
  std::vector<std::int32_t> sources = {3, 17, 20, 41};
  DistanceMatrix distances(4, 50);
  std::vector<double> x, y;
  for (std::size_t s = 0; s < 4; ++s) {
    distances.row(static_cast<Eigen::Index>(s)) = all.row(sources[s]);
    for (Eigen::Index j = 0; j < 50; ++j) {
      x.push_back((places.row(sources[s]) - places.row(j)).norm());
      y.push_back(all(sources[s], j));
    }
  }
  const Eigen::Map<Eigen::ArrayXd> a(x.data(), 200), b(y.data(), 200);
  const Eigen::ArrayXd da = a - a.mean(), db = b - b.mean();
  const double r = (da * db).sum() / std::sqrt(da.square().sum() * db.square().sum());
  EXPECT_NEAR(residual_variance(distances, sources, places, 1), 1.0 - r * r, 1e-12);
  EXPECT_EQ(residual_variance(distances, sources, places, 1),
            residual_variance(distances, sources, places, 2));
}

TEST(ResidualVariance, OfPerfectAndOfConstantDistances) {
  std::mt19937 random(34);
  const MapPlaces places = random_places(random, 20, 2.0, 1.0);
  std::vector<std::int32_t> sources(20);
  std::iota(sources.begin(), sources.end(), 0);
  EXPECT_NEAR(residual_variance(distances_between(places), sources, places, 1), 0.0, 1e-12);
  const MapPlaces alike = MapPlaces::Zero(20, 2);
  EXPECT_EQ(residual_variance(distances_between(places), sources, alike, 1), 1.0);
  EXPECT_EQ(residual_variance(distances_between(alike), sources, alike, 1), 0.0);
}

} // namespace
} // namespace phonomime
