// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <Eigen/Core>

namespace phonomime {

// Gaussian radial basis functions with ridge (X4-X6): output j at a point x is
//   F_j(x) = sum over k of w_kj exp(-|x - centre_k|^2 / (2 sigma^2))                          (X4)
// with w_j = (H^T H + lambda_j I)^-1 H^T y_j, H_ik = phi_k(centre_i)                          (X6)
// lambda_j makes the generalised cross-validation of output j least,
//   GCV_j = N |(I - A) y_j|^2 / trace(I - A)^2,  A = H (H^T H + lambda_j I)^-1 H^T,
// by setting its derivative to zero and estimating lambda anew until GCV rests, as X has it (Orr
// 1996), from the best of a few starts. One sigma for all centres; X gives none, so the one that
// makes the sum of all GCV_j least is taken (DESIGN section 7).
class RbfNetwork {
public:
  // `centres`: #centres by #inputs, at least 2, not all alike. `outputs`: #centres by #outputs.
  // `sigma` in the inputs' unit; 0 = by GCV. Throws InternalError where sizes do not agree.
  RbfNetwork(const FrameMatrixD& centres, const FrameMatrixD& outputs, double sigma = 0.0);

  double sigma() const { return sigma_; }
  const Eigen::VectorXd& lambda() const { return lambda_; } // #outputs
  const FrameMatrixD& weights() const { return weights_; }  // w of X4: #centres by #outputs
  double gcv() const { return gcv_; }                       // sum over outputs, in outputs squared

  // X4 for many points: #points by #inputs to #points by #outputs.
  FrameMatrixD at(const FrameMatrixD& points) const;

  // What each centre would get from a network of the others, with sigma and lambda as they are:
  // #centres by #outputs. In closed form: y_i - ((I - A) y)_i / (I - A)_ii.
  FrameMatrixD left_out() const;

private:
  FrameMatrixD centres_;
  FrameMatrixD outputs_;
  double sigma_ = 0.0;
  double gcv_ = 0.0;
  Eigen::VectorXd lambda_;
  FrameMatrixD weights_; // #centres by #outputs
};

} // namespace phonomime
