// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

namespace phonomime::store {

// The inverse of E11 for many frames: coefficients = basis^T (channels - mean), summed in double
// over the channels in their order and rounded to float once, so that every machine gets the same
// bits. (Eigen's own product blocks its sums by the sizes of the caches it finds.)
class Projection {
public:
  struct Job {
    FrameMatrix channels;     // #frames by #channels
    FrameMatrix coefficients; // #frames by #dimensions, the result
    FrameMatrixD centred;     // scratch
  };

  explicit Projection(const PcaModel& pca);

  // Gives a job its channels and all the memory it needs.
  void prepare(Job& job, FrameMatrix channels) const;

  // Computes the coefficients of a prepared job. Safe for several jobs at once in several threads.
  void run(Job& job) const noexcept;

private:
  Eigen::VectorXd mean_;
  FrameMatrixD basis_; // #channels by #dimensions, padded to whole tiles with zeros
  Eigen::Index dimensions_ = 0;
};

} // namespace phonomime::store
