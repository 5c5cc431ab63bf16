// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/smoothing_spline.h"

#include "db/types/errors.h"

#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

struct Problem {
  FrameMatrixD frames;
  std::vector<double> weights;
};

Problem random_problem(std::mt19937& random, int frames) {
  std::normal_distribution<double> value(0.0, 4.0);
  std::uniform_int_distribution<int> pick(0, 2);
  const double classes[] = {2.0, 1.0, 0.5};
  Problem problem;
  problem.frames.resize(frames, 3);
  for (Eigen::Index k = 0; k < problem.frames.size(); ++k) {
    problem.frames.data()[k] = value(random);
  }
  const double left = classes[pick(random)];
  const double right = classes[pick(random)];
  for (int i = 0; i < frames; ++i) {
    problem.weights.push_back(2 * i < frames ? left : right);
  }
  return problem;
}

FrameMatrixD fitted(const Problem& problem) {
  FrameMatrixD result = problem.frames;
  fit_smoothing_spline(result, problem.weights);
  return result;
}

Eigen::MatrixXd weight_matrix(const Problem& problem) {
  return Eigen::Map<const Eigen::VectorXd>(problem.weights.data(),
                                           static_cast<Eigen::Index>(problem.weights.size()))
      .asDiagonal();
}

// integral of |g''|^2 of the natural spline through g_1..g_n is g^T K g. K by brute force: the
// spline through each unit vector, its second derivatives from the textbook's dense system, and the
// integral of products of piecewise linear functions.
Eigen::MatrixXd roughness(Eigen::Index n) {
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n, n); // g'' at the knots, a column a unit vector
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, n);
  system(0, 0) = system(n - 1, n - 1) = 1.0; // natural ends
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    system(i, i - 1) = system(i, i + 1) = 1.0;
    system(i, i) = 4.0;
    right(i, i - 1) = right(i, i + 1) = 6.0;
    right(i, i) = -12.0;
  }
  second = system.fullPivLu().solve(right);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const auto a = second.row(i);
    const auto b = second.row(i + 1);
    result += (a.transpose() * a + b.transpose() * b) / 3.0 +
              (a.transpose() * b + b.transpose() * a) / 6.0;
  }
  return result;
}

double objective(const Problem& problem, const FrameMatrixD& g) { // E16
  const Eigen::MatrixXd off = g - problem.frames;
  return (off.transpose() * weight_matrix(problem) * off).trace() +
         (g.transpose() * roughness(g.rows()) * g).trace();
}

TEST(SmoothingSpline, SolvesE16AsDenseLinearAlgebraDoes) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    const Problem problem = random_problem(random, 3 + round % 12);
    const Eigen::MatrixXd weights = weight_matrix(problem);
    const Eigen::MatrixXd expected =
        (weights + roughness(problem.frames.rows())).fullPivLu().solve(weights * problem.frames);
    EXPECT_LT((fitted(problem) - expected).cwiseAbs().maxCoeff(), 1e-11);
  }
}

// Without any spline theory: g as a free curve on a fine grid, its second derivative by
// differences.
TEST(SmoothingSpline, SolvesE16AsAFreeCurveDoes) {
  std::mt19937 random(4);
  constexpr Eigen::Index kFine = 40;
  for (int frames = 3; frames <= 6; ++frames) {
    const Problem problem = random_problem(random, frames);
    const Eigen::Index n = (frames - 1) * kFine + 1;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, problem.frames.cols());
    constexpr double kSquare = static_cast<double>(kFine) * kFine;
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      Eigen::RowVectorXd difference = Eigen::RowVectorXd::Zero(n);
      difference.segment<3>(i - 1) << kSquare, -2.0 * kSquare, kSquare;
      system += difference.transpose() * difference / static_cast<double>(kFine);
    }
    for (Eigen::Index i = 0; i < frames; ++i) {
      const double weight = problem.weights[static_cast<std::size_t>(i)];
      system(i * kFine, i * kFine) += weight;
      right.row(i * kFine) = weight * problem.frames.row(i);
    }
    const Eigen::MatrixXd curve = system.ldlt().solve(right);
    const FrameMatrixD result = fitted(problem);
    for (Eigen::Index i = 0; i < frames; ++i) {
      EXPECT_LT((result.row(i) - curve.row(i * kFine)).cwiseAbs().maxCoeff(), 5e-3);
    }
  }
}

TEST(SmoothingSpline, IsLeftByEveryPerturbationForTheWorse) {
  std::mt19937 random(5);
  std::normal_distribution<double> nudge(0.0, 1e-2);
  for (int round = 0; round < 100; ++round) {
    const Problem problem = random_problem(random, 3 + round % 6);
    const FrameMatrixD best = fitted(problem);
    const double least = objective(problem, best);
    EXPECT_LE(least, objective(problem, problem.frames));
    for (Eigen::Index i = 0; i < best.rows(); ++i) {
      FrameMatrixD other = best;
      other(i, round % 3) += nudge(random);
      EXPECT_GT(objective(problem, other), least) << i;
    }
  }
}

TEST(SmoothingSpline, KeepsStraightLines) {
  FrameMatrixD line(6, 2);
  for (Eigen::Index i = 0; i < 6; ++i) {
    line.row(i) << 3.0 - 0.5 * static_cast<double>(i), 7.25;
  }
  const FrameMatrixD before = line;
  fit_smoothing_spline(line, std::vector<double>{2, 2, 2, 0.5, 0.5, 0.5});
  EXPECT_TRUE(line == before); // these numbers have no rounding: not a bit moves

  FrameMatrixD rough(6, 1);
  for (Eigen::Index i = 0; i < 6; ++i) {
    rough(i, 0) = 0.1 + static_cast<double>(i) / 3.0;
  }
  const FrameMatrixD rough_before = rough;
  fit_smoothing_spline(rough, std::vector<double>{1, 1, 1, 2, 2, 2});
  EXPECT_LT((rough - rough_before).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SmoothingSpline, LeavesFewerThanThreeFramesAlone) {
  for (const int frames : {0, 1, 2}) {
    FrameMatrixD values = FrameMatrixD::Random(frames, 2);
    const FrameMatrixD before = values;
    fit_smoothing_spline(values, std::vector<double>(static_cast<std::size_t>(frames), 2.0));
    EXPECT_TRUE(values == before);
  }
}

TEST(SmoothingSpline, MovesTheLessVisibleSideMore) {
  FrameMatrixD step(6, 1);
  step << 0, 0, 0, 1, 1, 1;
  fit_smoothing_spline(step, std::vector<double>{2, 2, 2, 0.5, 0.5, 0.5});
  const double left = step.topRows(3).cwiseAbs().sum();
  const double right = (step.bottomRows(3).array() - 1.0).abs().sum();
  EXPECT_GT(right, 1.5 * left);
  EXPECT_LT(step(3, 0) - step(2, 0), 0.5); // and the jump is less than half of what it was
}

TEST(SmoothingSpline, RefusesWeightsThatCannotBe) {
  FrameMatrixD frames = FrameMatrixD::Zero(4, 1);
  EXPECT_THROW(fit_smoothing_spline(frames, std::vector<double>{1, 1, 1}), InternalError);
  EXPECT_THROW(fit_smoothing_spline(frames, std::vector<double>{1, 0, 1, 1}), InternalError);
  EXPECT_THROW(fit_smoothing_spline(frames, std::vector<double>{1, 1, 1, std::nan("")}),
               InternalError);
}

} // namespace
} // namespace phonomime
