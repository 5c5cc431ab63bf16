// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/bounded_least_squares.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Problem {
  Eigen::MatrixXd matrix; // A
  Eigen::VectorXd goal;   // b
  Eigen::VectorXd lower, upper;

  Eigen::MatrixXd gram() const { return matrix.transpose() * matrix; }
  Eigen::VectorXd right() const { return matrix.transpose() * goal; }
  double cost(const Eigen::VectorXd& x) const { return (matrix * x - goal).squaredNorm(); }
};

Eigen::MatrixXd normal(std::mt19937_64& draw, Eigen::Index rows, Eigen::Index columns) {
  std::normal_distribution<double> number;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(draw); });
}

Problem random_problem(std::mt19937_64& draw, Eigen::Index rows, Eigen::Index unknowns,
                       double upper) {
  Problem problem;
  problem.matrix = normal(draw, rows, unknowns);
  problem.goal = problem.matrix * normal(draw, unknowns, 1) + 0.3 * normal(draw, rows, 1);
  problem.lower = Eigen::VectorXd::Zero(unknowns);
  problem.upper = Eigen::VectorXd::Constant(unknowns, upper);
  return problem;
}

// The Karush-Kuhn-Tucker conditions, which for a convex problem say that x is the least: inside the
// bounds the gradient is 0, at a bound it points out of them.
void expect_optimal(const Problem& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd gradient = problem.matrix.transpose() * (problem.matrix * x - problem.goal);
  const double scale = problem.goal.norm() + (problem.matrix * x).norm();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    ASSERT_GE(x[i], problem.lower[i]);
    ASSERT_LE(x[i], problem.upper[i]);
    const double slope = gradient[i] / std::max(problem.matrix.col(i).norm(), 1e-300);
    const double tolerance = 1e-11 * scale;
    if (x[i] > problem.lower[i]) {
      EXPECT_LE(slope, tolerance) << "unknown " << i;
    }
    if (x[i] < problem.upper[i]) {
      EXPECT_GE(slope, -tolerance) << "unknown " << i;
    }
  }
}

Eigen::VectorXd solved(const Problem& problem) {
  BoundedLeastSquares solver(problem.gram(), problem.lower, problem.upper);
  return solver.solve(problem.right());
}

// Every choice of who is at which bound, tried one by one: the least cost of all that are feasible.
double exhaustive_cost(const Problem& problem) {
  const auto n = static_cast<int>(problem.lower.size());
  const Eigen::MatrixXd gram = problem.gram();
  const Eigen::VectorXd right = problem.right();
  double least = kInfinity;
  const auto choices = static_cast<int>(std::lround(std::pow(3.0, n)));
  for (int choice = 0; choice < choices; ++choice) {
    Eigen::VectorXd x(n);
    std::vector<int> free;
    int left = choice;
    for (int i = 0; i < n; ++i, left /= 3) {
      x[i] = left % 3 == 1 ? problem.upper[i] : problem.lower[i];
      if (left % 3 == 2) {
        free.push_back(i);
        x[i] = 0.0;
      }
    }
    if (!x.allFinite()) {
      continue;
    }
    if (!free.empty()) {
      const Eigen::MatrixXd part = gram(free, free);
      const Eigen::VectorXd side = right - gram * x;
      const Eigen::VectorXd inside = part.fullPivLu().solve(side(free));
      x(free) = inside;
    }
    if ((x.array() >= problem.lower.array()).all() && (x.array() <= problem.upper.array()).all()) {
      least = std::min(least, problem.cost(x));
    }
  }
  return least;
}

TEST(BoundedLeastSquares, AgreesWithEveryChoiceOfBoundsTriedOneByOne) {
  std::mt19937_64 draw(7);
  for (int round = 0; round < 60; ++round) {
    const Problem problem = random_problem(draw, 9, 6, round % 2 == 0 ? 0.8 : kInfinity);
    const double least = exhaustive_cost(problem);
    EXPECT_NEAR(problem.cost(solved(problem)), least, 1e-10 * (1.0 + least)) << "round " << round;
  }
}

TEST(BoundedLeastSquares, MeetsTheOptimalityConditions) {
  std::mt19937_64 draw(11);
  for (int round = 0; round < 40; ++round) {
    Problem problem = random_problem(draw, 60, 40, round % 2 == 0 ? 1.0 : kInfinity);
    if (round % 3 == 0) { // columns of very different length
      for (Eigen::Index i = 0; i < 40; ++i) {
        problem.matrix.col(i) *= std::pow(10.0, static_cast<double>(i % 7) - 3.0);
      }
    }
    expect_optimal(problem, solved(problem));
  }
}

TEST(BoundedLeastSquares, TakesColumnsThatDependOnEachOther) {
  std::mt19937_64 draw(13);
  for (int round = 0; round < 40; ++round) {
    Problem problem = random_problem(draw, 30, 12, 1.0);
    problem.matrix.col(3) = problem.matrix.col(0);
    problem.matrix.col(5) = -problem.matrix.col(1);
    problem.matrix.col(7) = problem.matrix.col(0) + 0.5 * problem.matrix.col(2);
    problem.matrix.col(9).setZero();
    expect_optimal(problem, solved(problem));
  }
  for (int round = 0; round < 40; ++round) { // more unknowns than equations
    const Problem problem = random_problem(draw, 10, 25, round % 2 == 0 ? 0.3 : kInfinity);
    expect_optimal(problem, solved(problem));
  }
}

TEST(BoundedLeastSquares, GoesDownALineWhereALinearCostLeavesAChoice) {
  // |x0 + x1 - 1|^2 + 0.2 x0 + 0.1 x1: only x1, and that within its bound.
  Eigen::MatrixXd gram(2, 2);
  gram << 2, 2, 2, 2;
  BoundedLeastSquares solver(gram, Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0.5));
  solver.start_from(Eigen::Vector2d(0.5, 0.0));
  const Eigen::VectorXd x = solver.solve(Eigen::Vector2d(2 - 0.2, 2 - 0.1));
  EXPECT_NEAR(x[1], 0.5, 1e-12);
  EXPECT_NEAR(x[0], 0.4, 1e-12);
}

TEST(BoundedLeastSquares, GivesTheSameBitsWarmAndCold) {
  std::mt19937_64 draw(17);
  const Problem problem = random_problem(draw, 80, 30, 1.0);
  BoundedLeastSquares warm(problem.gram(), problem.lower, problem.upper);
  Eigen::VectorXd goal = problem.goal;
  for (int frame = 0; frame < 200; ++frame) {
    goal += 0.1 * normal(draw, goal.size(), 1);
    const Eigen::VectorXd right = problem.matrix.transpose() * goal;
    BoundedLeastSquares cold(problem.gram(), problem.lower, problem.upper);
    const Eigen::VectorXd expected = cold.solve(right);
    EXPECT_EQ(warm.solve(right), expected) << "frame " << frame;
    if (frame > 0) {
      EXPECT_LE(warm.steps(), cold.steps());
    }
    BoundedLeastSquares elsewhere(problem.gram(), problem.lower, problem.upper);
    elsewhere.start_from(normal(draw, 30, 1));
    EXPECT_EQ(elsewhere.solve(right), expected) << "frame " << frame;
  }
}

TEST(BoundedLeastSquares, KeepsItsBoundsWhateverTheirPlace) {
  std::mt19937_64 draw(19);
  for (int round = 0; round < 30; ++round) {
    Problem problem = random_problem(draw, 25, 10, 1.0);
    problem.lower = -0.4 * normal(draw, 10, 1).cwiseAbs() - Eigen::VectorXd::Constant(10, 0.1);
    problem.upper =
        problem.lower + normal(draw, 10, 1).cwiseAbs() + Eigen::VectorXd::Constant(10, 0.1);
    expect_optimal(problem, solved(problem));
  }
}

TEST(BoundedLeastSquares, RefusesWhatDoesNotFit) {
  const Eigen::MatrixXd gram = Eigen::MatrixXd::Identity(2, 2);
  EXPECT_THROW(BoundedLeastSquares(gram, Eigen::Vector2d(0, 0), Eigen::Vector3d(1, 1, 1)),
               InternalError);
  EXPECT_THROW(BoundedLeastSquares(gram, Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1)),
               InternalError);
  BoundedLeastSquares solver(gram, Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1));
  EXPECT_THROW(solver.solve(Eigen::Vector3d(1, 1, 1)), InternalError);
  EXPECT_THROW(solver.solve(Eigen::Vector2d(1, std::nan(""))), InternalError);
}

} // namespace
} // namespace phonomime
