// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <Eigen/Core>

namespace phonomime {

struct WeightOptions {
  double upper = 1.0; // largest weight; infinity: only non-negative, as T Eq. 3.2
  // Of the mean squared length of the shapes: added as that much times |w|^2.
  double ridge = 0.0;
  // By how much a weight of a shape that resembles no other is pulled to 0 (adds a cost linear in
  // the weights: many become exactly 0).
  double sparsity = 0.0;
  // Length in frames over which a shape of mean length that resembles no other is smoothed: adds
  // smoothness^2 times the mean squared length times |w_t - w_(t-1)|^2, solved over all frames.
  double smoothness = 0.0;

  // Throws UsageError that names the value.
  void validate() const;
};

// What a solve did.
struct WeightReport {
  Eigen::Index missing_values = 0; // left out of their frames
  int sweeps = 1;                  // over the frames, where smoothness couples them
  double last_change = 0.0;        // of any weight in the last sweep
};

// Weights of shapes for each frame of a motion (T Eq. 3.2):
//     sum over frames of |A w_t - b_t|^2 + the terms of WeightOptions, 0 <= w <= upper,
// each row's squares weighted. A's Gram matrix is made once; each frame's solve starts from the
// frame before it.
class WeightSolver {
public:
  // `shapes`: #rows by #shapes, offsets from the reference pose. `row_weights`: #rows, not negative
  // (of squares), or empty for ones. Throws InternalError where sizes differ.
  WeightSolver(Eigen::MatrixXd shapes, const Eigen::VectorXd& row_weights,
               const WeightOptions& options);

  // `frames`: #frames by #rows, offsets from the reference pose; NaN = missing, which leaves that
  // row out of that frame. Result: #frames by #shapes. One thread, the same bits always.
  FrameMatrixD solve(const FrameMatrixD& frames, WeightReport* report = nullptr) const;

private:
  FrameMatrixD right_sides(const FrameMatrixD& frames) const;
  Eigen::MatrixXd gram_without(const Eigen::Ref<const Eigen::RowVectorXd>& frame) const;

  Eigen::MatrixXd shapes_;   // each row times the root of its weight
  Eigen::VectorXd row_root_; // #rows
  WeightOptions options_;
  Eigen::MatrixXd gram_; // #shapes by #shapes, with the ridge
  double mean_square_ = 0.0;
};

} // namespace phonomime
