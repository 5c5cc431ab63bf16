// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/weight_solver.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/retarget/bounded_least_squares.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace phonomime {
namespace {

constexpr int kMostSweeps = 500;
constexpr double kSmallestChange = 1e-9; // of a weight, below which sweeps end

void check(double value, std::string_view name, bool positive) {
  if (!(value >= 0.0) || (positive ? value == 0.0 : std::isinf(value))) {
    throw UsageError({.what = std::string(name) + " is out of range",
                      .expected = positive ? "a number above 0" : "a number from 0 on",
                      .got = format_number(value)});
  }
}

bool same_gaps(const Eigen::Ref<const Eigen::RowVectorXd>& a,
               const Eigen::Ref<const Eigen::RowVectorXd>& b) {
  return (a.array().isNaN() == b.array().isNaN()).all();
}

} // namespace

void WeightOptions::validate() const {
  check(upper, "the largest weight", true);
  check(ridge, "the ridge", false);
  check(sparsity, "the sparsity", false);
  check(smoothness, "the smoothness", false);
}

WeightSolver::WeightSolver(Eigen::MatrixXd shapes, const Eigen::VectorXd& row_weights,
                           const WeightOptions& options)
    : shapes_(std::move(shapes)), options_(options) {
  options_.validate();
  if ((row_weights.size() != 0 && row_weights.size() != shapes_.rows()) || !shapes_.allFinite() ||
      !(row_weights.array() >= 0.0).all()) {
    throw InternalError({.what = "shapes and row weights do not fit each other"});
  }
  row_root_ = row_weights.size() == 0 ? Eigen::VectorXd::Ones(shapes_.rows()).eval()
                                      : row_weights.cwiseSqrt().eval();
  shapes_ = row_root_.asDiagonal() * shapes_;
  gram_ = shapes_.transpose() * shapes_;
  mean_square_ = shapes_.cols() == 0 ? 0.0 : gram_.diagonal().mean();
  gram_.diagonal().array() += options_.ridge * mean_square_;
}

// r of each frame, #frames by #shapes: A' b without the missing rows, less the linear cost.
FrameMatrixD WeightSolver::right_sides(const FrameMatrixD& frames) const {
  const FrameMatrixD known =
      frames.array().isNaN().select(0.0, frames).matrix() * row_root_.asDiagonal();
  FrameMatrixD result = known * shapes_;
  result.array() -= options_.sparsity * mean_square_;
  return result;
}

// The Gram matrix without a frame's missing rows.
Eigen::MatrixXd
WeightSolver::gram_without(const Eigen::Ref<const Eigen::RowVectorXd>& frame) const {
  Eigen::Index known = 0;
  Eigen::MatrixXd rows(shapes_.rows(), shapes_.cols());
  for (Eigen::Index row = 0; row < frame.size(); ++row) {
    if (!std::isnan(frame[row])) {
      rows.row(known++) = shapes_.row(row);
    }
  }
  Eigen::MatrixXd gram = rows.topRows(known).transpose() * rows.topRows(known);
  gram.diagonal().array() += options_.ridge * mean_square_;
  return gram;
}

FrameMatrixD WeightSolver::solve(const FrameMatrixD& frames, WeightReport* report) const {
  if (frames.cols() != shapes_.rows()) {
    throw InternalError({.what = "frames do not fit the shapes' rows"});
  }
  const Eigen::Index n = shapes_.cols();
  FrameMatrixD weights = FrameMatrixD::Zero(frames.rows(), n);
  const FrameMatrixD right = right_sides(frames);
  const double pull = options_.smoothness * options_.smoothness * mean_square_;
  const bool coupled = pull > 0.0 && frames.rows() > 1;
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(n);
  const Eigen::VectorXd upper = Eigen::VectorXd::Constant(n, options_.upper);
  WeightReport done;
  done.missing_values = frames.array().isNaN().count();

  // One solver for all frames with the same gaps and as many neighbours.
  std::optional<BoundedLeastSquares> solver;
  Eigen::Index solver_of = -1;
  int solver_neighbours = 0;
  const auto solve_frame = [&](Eigen::Index t) {
    const int neighbours = coupled ? (t > 0) + (t + 1 < frames.rows()) : 0;
    if (!solver || neighbours != solver_neighbours ||
        !same_gaps(frames.row(t), frames.row(solver_of))) {
      const bool whole = !frames.row(t).hasNaN();
      Eigen::MatrixXd gram = whole ? gram_ : gram_without(frames.row(t));
      gram.diagonal().array() += neighbours * pull;
      solver.emplace(std::move(gram), lower, upper);
      if (t > 0) {
        solver->start_from(weights.row(t - 1).transpose());
      }
    }
    solver_of = t;
    solver_neighbours = neighbours;
    Eigen::VectorXd side = right.row(t).transpose();
    if (coupled && t > 0) {
      side += pull * weights.row(t - 1).transpose();
    }
    if (coupled && t + 1 < frames.rows()) {
      side += pull * weights.row(t + 1).transpose();
    }
    const Eigen::VectorXd& found = solver->solve(side);
    const double change = (found.transpose() - weights.row(t)).cwiseAbs().maxCoeff();
    weights.row(t) = found.transpose();
    return change;
  };
  if (n == 0) {
    return weights;
  }
  for (Eigen::Index t = 0; t < frames.rows(); ++t) {
    done.last_change = std::max(done.last_change, solve_frame(t));
  }
  // Block coordinate descent over the frames, there and back: convex, so that it ends at the least.
  while (coupled && done.last_change > kSmallestChange && done.sweeps < kMostSweeps) {
    done.last_change = 0.0;
    for (Eigen::Index k = 0; k < frames.rows(); ++k) {
      const Eigen::Index t = done.sweeps % 2 == 0 ? k : frames.rows() - 1 - k;
      done.last_change = std::max(done.last_change, solve_frame(t));
    }
    ++done.sweeps;
  }
  if (report != nullptr) {
    *report = done;
  }
  return weights;
}

} // namespace phonomime
