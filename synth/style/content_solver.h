// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace phonomime {

// T2.10 and T2.11 in one: y_new = matrix * y + shift.
struct Translation {
  Eigen::MatrixXd matrix; // #wanted rows by K
  Eigen::VectorXd shift;  // #wanted rows
};

// Contents of frames whose style is known: T2.10 with a ridge, drawn to the mean content m of the
// training data instead of to 0:
//   c = m + (B' B + ridge I)^-1 B' (y - B m)
// As contents have mean squares of 1, the ridge is a variance of y: of that which a frame shows
// beside the model. 0 is T2.10 itself by the pseudo-inverse.
class ContentSolver {
public:
  // basis: K by J, mean_content: J. Both must be finite: InternalError.
  ContentSolver(const Eigen::Ref<const Eigen::MatrixXd>& basis, Eigen::VectorXd mean_content);

  // J by K: the linear part.
  Eigen::MatrixXd map(double ridge) const;

  // y (K by #frames) into contents (J by #frames).
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& y, double ridge) const;

  // From frames of this style to the basis of another (any number of its rows, by J), with
  // map(ridge).
  Translation to(const Eigen::Ref<const Eigen::MatrixXd>& wanted,
                 const Eigen::Ref<const Eigen::MatrixXd>& map) const;

private:
  Eigen::MatrixXd left_;   // K by r
  Eigen::VectorXd values_; // r
  Eigen::MatrixXd right_;  // J by r
  Eigen::VectorXd mean_content_;
  Eigen::VectorXd mean_; // K: B m
};

} // namespace phonomime
