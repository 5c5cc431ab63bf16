// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/rbf_network.h"
#include "tests/synth/retarget/mapping/made_pairs.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

// Smooth functions of two inputs, with noise: 40 centres, 3 outputs (the last is always 0).
struct Sample {
  FrameMatrixD centres = made_matrix(40, 2, 10.0, 1);
  FrameMatrixD outputs =
      truth(centres) + made_matrix(40, 3, 0.03, 2) * Eigen::Vector3d(1, 1, 0).asDiagonal();

  static FrameMatrixD truth(const FrameMatrixD& points) {
    FrameMatrixD values(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      values.row(i) << 0.5 + 0.4 * std::sin(0.3 * points(i, 0)),
          std::exp(-0.01 * points.row(i).squaredNorm()), 0.0;
    }
    return values;
  }
};

// H as X6 has it, with the C library's exponential.
Eigen::MatrixXd plain_basis(const FrameMatrixD& points, const FrameMatrixD& centres, double sigma) {
  Eigen::MatrixXd h(points.rows(), centres.rows());
  for (Eigen::Index i = 0; i < h.rows(); ++i) {
    for (Eigen::Index k = 0; k < h.cols(); ++k) {
      h(i, k) = std::exp(-(points.row(i) - centres.row(k)).squaredNorm() / (2.0 * sigma * sigma));
    }
  }
  return h;
}

// I - A of an output, in the plain way.
Eigen::MatrixXd plain_residual(const Eigen::MatrixXd& h, double lambda) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(h.rows(), h.rows());
  return identity - h * (h.transpose() * h + lambda * identity).inverse() * h.transpose();
}

double plain_gcv(const Eigen::MatrixXd& h, const Eigen::VectorXd& y, double lambda) {
  const Eigen::MatrixXd left = plain_residual(h, lambda);
  return static_cast<double>(y.size()) * (left * y).squaredNorm() / (left.trace() * left.trace());
}

} // namespace

TEST(RbfNetwork, IsTheRidgeRegressionOfX4ToX6) {
  const Sample sample;
  const RbfNetwork network(sample.centres, sample.outputs, 6.0);
  const Eigen::MatrixXd h = plain_basis(sample.centres, sample.centres, 6.0);
  const FrameMatrixD points = made_matrix(301, 2, 12.0, 3);
  const FrameMatrixD found = network.at(points);
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Eigen::MatrixXd normal =
        h.transpose() * h + network.lambda()(j) * Eigen::MatrixXd::Identity(40, 40);
    const Eigen::VectorXd weights = normal.fullPivLu().solve(h.transpose() * sample.outputs.col(j));
    EXPECT_LT((plain_basis(points, sample.centres, 6.0) * weights - found.col(j)).norm(),
              1e-7 * std::sqrt(301.0))
        << "output " << j;
  }
}

TEST(RbfNetwork, LambdaMakesGeneralisedCrossValidationLeast) {
  const Sample sample;
  const RbfNetwork network(sample.centres, sample.outputs, 6.0);
  const Eigen::MatrixXd h = plain_basis(sample.centres, sample.centres, 6.0);
  double sum = 0.0;
  for (Eigen::Index j = 0; j < 2; ++j) {
    const double found = plain_gcv(h, sample.outputs.col(j), network.lambda()(j));
    sum += found;
    for (double lambda = 1e-5; lambda < 1e5; lambda *= 1.05) {
      EXPECT_LE(found, plain_gcv(h, sample.outputs.col(j), lambda) * (1.0 + 1e-7))
          << "output " << j << ", lambda " << lambda;
    }
  }
  EXPECT_NEAR(network.gcv(), sum, 1e-7 * sum);
}

TEST(RbfNetwork, SigmaMakesGeneralisedCrossValidationLeast) {
  const Sample sample;
  const RbfNetwork network(sample.centres, sample.outputs);
  for (double sigma = 1.5; sigma < 90.0; sigma *= 1.2) {
    EXPECT_LE(network.gcv(), RbfNetwork(sample.centres, sample.outputs, sigma).gcv() * 1.001)
        << "sigma " << sigma;
  }
}

TEST(RbfNetwork, NoiseIsSmoothedAway) {
  const Sample sample;
  const RbfNetwork network(sample.centres, sample.outputs);
  const FrameMatrixD points = made_matrix(500, 2, 8.0, 4);
  const FrameMatrixD error = network.at(points) - Sample::truth(points);
  EXPECT_LT(std::sqrt(error.array().square().mean()), 0.015) << "noise has 0.017 in two of three";
  EXPECT_EQ(error.col(2).cwiseAbs().maxCoeff(), 0.0) << "what no pair uses stays 0";
}

TEST(RbfNetwork, LeftOutIsWhatAFitWithoutThePairGives) {
  const Sample sample;
  const RbfNetwork network(sample.centres, sample.outputs, 6.0);
  const Eigen::MatrixXd h = plain_basis(sample.centres, sample.centres, 6.0);
  const FrameMatrixD left_out = network.left_out();
  for (Eigen::Index i = 0; i < 40; i += 7) {
    Eigen::MatrixXd others = h;
    others.row(i).setZero();
    for (Eigen::Index j = 0; j < 2; ++j) {
      Eigen::VectorXd y = sample.outputs.col(j);
      y(i) = 0.0;
      const Eigen::MatrixXd normal =
          others.transpose() * others + network.lambda()(j) * Eigen::MatrixXd::Identity(40, 40);
      const Eigen::VectorXd weights = normal.fullPivLu().solve(others.transpose() * y);
      EXPECT_NEAR(left_out(i, j), h.row(i).dot(weights), 1e-6);
    }
  }
}

TEST(RbfNetwork, APointGetsTheSameAloneAndAmongOthers) {
  const Sample sample;
  const RbfNetwork network(sample.centres, sample.outputs, 6.0);
  const FrameMatrixD points = made_matrix(131, 2, 12.0, 5);
  const FrameMatrixD together = network.at(points);
  for (const Eigen::Index i : {0, 5, 127, 128, 130}) {
    EXPECT_LT((network.at(points.row(i)) - together.row(i)).norm(), 1e-12) << "point " << i;
  }
}

} // namespace phonomime::test
