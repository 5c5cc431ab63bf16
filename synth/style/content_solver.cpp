// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/content_solver.h"

#include "db/types/errors.h"
#include "synth/style/singular_vectors.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace phonomime {

ContentSolver::ContentSolver(const Eigen::Ref<const Eigen::MatrixXd>& basis,
                             Eigen::VectorXd mean_content)
    : mean_content_(std::move(mean_content)) {
  if (!basis.allFinite() || !mean_content_.allFinite()) {
    throw InternalError({.what = "a style model has a number that is not finite"});
  }
  const SingularVectors found = singular_vectors(basis);
  left_ = found.left;
  values_ = found.values;
  right_ = found.right;
  mean_ = basis * mean_content_;
}

Eigen::MatrixXd ContentSolver::map(double ridge) const {
  // Without a ridge, directions that are nothing but rounding are left out (pseudo-inverse).
  const double least = values_[0] * std::numeric_limits<double>::epsilon() *
                       static_cast<double>(std::max(left_.rows(), right_.rows()));
  const Eigen::VectorXd inverse = values_.unaryExpr(
      [&](double value) { return value > least ? value / (value * value + ridge) : 0.0; });
  return right_ * inverse.asDiagonal() * left_.transpose();
}

Eigen::MatrixXd ContentSolver::solve(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                     double ridge) const {
  return (map(ridge) * (y.colwise() - mean_)).colwise() + mean_content_;
}

Translation ContentSolver::to(const Eigen::Ref<const Eigen::MatrixXd>& wanted,
                              const Eigen::Ref<const Eigen::MatrixXd>& map) const {
  Translation found;
  found.matrix = wanted * map;
  found.shift = wanted * mean_content_ - found.matrix * mean_;
  return found;
}

} // namespace phonomime
