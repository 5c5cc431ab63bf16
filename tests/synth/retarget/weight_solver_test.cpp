// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/weight_solver.h"

#include "db/types/errors.h"
#include "synth/retarget/bounded_least_squares.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::MatrixXd normal(std::mt19937_64& draw, Eigen::Index rows, Eigen::Index columns) {
  std::normal_distribution<double> number;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(draw); });
}

// Weights between 0 and 1 that move slowly, many of them 0: #frames by #shapes.
FrameMatrixD slow_weights(Eigen::Index frames, Eigen::Index shapes) {
  return FrameMatrixD::NullaryExpr(frames, shapes, [](Eigen::Index t, Eigen::Index i) {
    return std::max(0.0, std::sin(0.05 * static_cast<double>(t * (1 + i % 5) + 13 * i)));
  });
}

TEST(WeightSolver, FindsTheWeightsThatMadeTheMotion) {
  std::mt19937_64 draw(1);
  const Eigen::MatrixXd shapes = normal(draw, 60, 12);
  const FrameMatrixD weights = slow_weights(100, 12);
  FrameMatrixD frames = weights * shapes.transpose();
  const WeightSolver solver(shapes, {}, {});
  EXPECT_LT((solver.solve(frames) - weights).cwiseAbs().maxCoeff(), 1e-12);

  frames.col(7).setConstant(std::nan("")); // markers missing: their rows are left out
  frames.block(20, 30, 15, 9).setConstant(std::nan(""));
  WeightReport report;
  EXPECT_LT((solver.solve(frames, &report) - weights).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(report.missing_values, 100 + 15 * 9);
}

TEST(WeightSolver, WeighsRows) {
  // Two rows ask for different weights of one shape: the mean of 1 and 0.2, one counted thrice.
  const Eigen::MatrixXd shape = Eigen::MatrixXd::Ones(2, 1);
  const FrameMatrixD frame = (FrameMatrixD(1, 2) << 1.0, 0.2).finished();
  EXPECT_NEAR(WeightSolver(shape, Eigen::Vector2d(1, 3), {}).solve(frame)(0, 0), 0.4, 1e-12);
}

TEST(WeightSolver, PullsToZeroAsItsOptionsSay) {
  const Eigen::MatrixXd shapes = 2.0 * Eigen::MatrixXd::Identity(2, 2);
  const FrameMatrixD frame = (FrameMatrixD(1, 2) << 1.6, 0.1).finished(); // weights 0.8, 0.05
  const FrameMatrixD sparse = WeightSolver(shapes, {}, {.sparsity = 0.1}).solve(frame);
  EXPECT_NEAR(sparse(0, 0), 0.7, 1e-12);
  EXPECT_EQ(sparse(0, 1), 0.0);
  const FrameMatrixD ridge = WeightSolver(shapes, {}, {.ridge = 1.0}).solve(frame);
  EXPECT_NEAR(ridge(0, 0), 0.4, 1e-12);
  EXPECT_NEAR(ridge(0, 1), 0.025, 1e-12);
  EXPECT_EQ(WeightSolver(shapes, {}, {.upper = 0.5}).solve(frame)(0, 0), 0.5);
  const FrameMatrixD large = 10.0 * frame;
  EXPECT_NEAR(WeightSolver(shapes, {}, {.upper = kInfinity}).solve(large)(0, 0), 8.0, 1e-12);
}

TEST(WeightSolver, SmoothsOverAllFramesAtOnce) {
  std::mt19937_64 draw(3);
  const Eigen::Index n = 4;
  const Eigen::Index count = 12;
  const Eigen::MatrixXd shapes = normal(draw, 9, n);
  const FrameMatrixD frames =
      slow_weights(count, n) * shapes.transpose() + FrameMatrixD(normal(draw, count, 9));
  const double pull = 1.5 * 1.5 * (shapes.transpose() * shapes).diagonal().mean();
  // The same as one problem with all frames' weights as unknowns.
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count * n, count * n);
  Eigen::VectorXd right(count * n);
  const Eigen::MatrixXd couple = pull * Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index t = 0; t < count; ++t) {
    gram.block(t * n, t * n, n, n) += shapes.transpose() * shapes;
    right.segment(t * n, n) = shapes.transpose() * frames.row(t).transpose();
    if (t > 0) {
      gram.block(t * n, t * n, n, n) += couple;
      gram.block((t - 1) * n, (t - 1) * n, n, n) += couple;
      gram.block(t * n, (t - 1) * n, n, n) -= couple;
      gram.block((t - 1) * n, t * n, n, n) -= couple;
    }
  }
  BoundedLeastSquares whole(gram, Eigen::VectorXd::Zero(count * n),
                            Eigen::VectorXd::Ones(count * n));
  const Eigen::VectorXd expected = whole.solve(right);
  WeightReport report;
  const FrameMatrixD found = WeightSolver(shapes, {}, {.smoothness = 1.5}).solve(frames, &report);
  EXPECT_GT(report.sweeps, 2);
  EXPECT_LT(report.last_change, 1e-8);
  for (Eigen::Index t = 0; t < count; ++t) {
    EXPECT_LT((found.row(t).transpose() - expected.segment(t * n, n)).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(WeightSolver, RefusesOptionsOutOfRange) {
  try {
    WeightOptions{.upper = 0.0}.validate();
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "the largest weight is out of range (expected a number above 0, got 0)");
  }
  EXPECT_THROW(WeightOptions{.ridge = -1.0}.validate(), UsageError);
  EXPECT_THROW(WeightOptions{.smoothness = kInfinity}.validate(), UsageError);
  EXPECT_NO_THROW(WeightOptions{.upper = kInfinity}.validate());
}

} // namespace
} // namespace phonomime
