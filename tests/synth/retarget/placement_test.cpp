// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/placement.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

Points random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 30.0);
  return Points::NullaryExpr(count, 3, [&] { return normal(random); });
}

TEST(Placement, RecoversASimilarity) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Points from = random_points(12, seed);
    const Eigen::Matrix3d rotation =
        Eigen::Quaterniond(1.0, 0.3 * seed, -0.2, 0.1 * seed).normalized().toRotationMatrix();
    const double scale = 0.01 * (seed + 1);
    Points to = (scale * from) * rotation.transpose();
    to.rowwise() += Eigen::RowVector3d(5, -7, 200);
    const Similarity fit = fit_similarity(from, to);
    EXPECT_NEAR(fit.scale, scale, 1e-10);
    EXPECT_LT((fit.rotation - rotation).norm(), 1e-9);
    EXPECT_LT((fit.apply(from) - to).norm(), 1e-8);
    EXPECT_LT(fit.rms, 1e-9);
  }
}

TEST(Placement, NeverMirrors) {
  const Points from = random_points(30, 3);
  Points mirrored = from;
  mirrored.col(0) *= -1.0;
  const Similarity fit = fit_similarity(from, mirrored);
  EXPECT_NEAR(fit.rotation.determinant(), 1.0, 1e-9);
  EXPECT_GT(fit.rms, 1.0);
}

// At the least-squares fit no small change of scale, turn or place makes the distance smaller.
TEST(Placement, IsTheLeastSquaresFit) {
  const Points from = random_points(15, 4);
  const Points to = from * 2.0 + 0.3 * random_points(15, 5);
  const Similarity fit = fit_similarity(from, to);
  const double best = (fit.apply(from) - to).squaredNorm();
  for (const double step : {1e-3, -1e-3}) {
    for (int axis = 0; axis < 3; ++axis) {
      Similarity turned = fit;
      turned.rotation =
          Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(axis)).toRotationMatrix() * fit.rotation;
      turned.translation = fit.translation + (fit.rotation - turned.rotation) * fit.scale *
                                                 from.colwise().mean().transpose();
      EXPECT_GT((turned.apply(from) - to).squaredNorm(), best);
      Similarity moved = fit;
      moved.translation(axis) += step;
      EXPECT_GT((moved.apply(from) - to).squaredNorm(), best);
    }
    Similarity scaled = fit;
    scaled.scale *= 1.0 + step;
    EXPECT_GT((scaled.apply(from) - to).squaredNorm(), best);
  }
}

} // namespace
} // namespace phonomime
