// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <cstddef>

namespace phonomime {

// Linear features of the ends of motion nodes: pose rows times the PCA coefficients of the edge
// frame, then velocity rows times their one-sided change inside the node in units per second (0 for
// a node of one frame).
class LinearFeatures {
public:
  // Both #rows by #dimensions; features are padded with zeros to `stride`, a multiple of four.
  LinearFeatures(const MotionTable& table, const FrameMatrixD& pose_rows,
                 const FrameMatrixD& velocity_rows, std::size_t stride);

  std::size_t end_floats() const { return 2 * stride_; }

  // end_floats() floats each.
  void fill_first(NodeIndex node, float* features) const;
  void fill_last(NodeIndex node, float* features) const;

  // What rounding can add to a bound of alpha3 PGap + VGap that sums these features: theirs to
  // float, those of the full poses that the exact cost compares, and of the sums themselves.
  // `largest_frame`: of the table, as largest_frame_norm().
  double rounding_margin(double alpha3, double largest_frame) const;

private:
  void fill_end(float* features, std::int64_t edge, std::int64_t before, std::int64_t after) const;

  const MotionTable& table_;
  std::size_t stride_;
  FrameMatrixD pose_;     // #dimensions by stride: transposed
  FrameMatrixD velocity_; // times the rate
};

// The largest Euclidean norm of a frame's coefficients, or a little more.
double largest_frame_norm(const MotionTable& table);

} // namespace phonomime
