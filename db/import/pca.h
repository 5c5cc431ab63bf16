// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace phonomime {

// Mean and covariance of frames.
struct FrameStatistics {
  Eigen::VectorXd mean;       // #channels
  Eigen::MatrixXd covariance; // #channels by #channels, divided by the number of frames
  std::int64_t frames = 0;    // that were taken
  std::int64_t left_out = 0;
};

// Gathers frames for a PCA in blocks of a fixed size, whose sums are added in order, so that the
// number of threads does not change a bit. All in double, about the mean of the first frames.
class CovarianceAccumulator {
public:
  // `threads` 0: as many as there are.
  CovarianceAccumulator(Eigen::Index channel_count, int threads);

  // `channels`: #frames by #channels; a frame whose `leave_out` is not 0 does not count.
  void add(const FrameMatrix& channels, const std::vector<std::uint8_t>& leave_out);

  FrameStatistics finish();

private:
  void flush();

  Eigen::Index channel_count_;
  int threads_;
  FrameMatrixD waiting_; // a block of frames, summed when full
  Eigen::Index waiting_count_ = 0;
  Eigen::VectorXd origin_;      // about which sums are taken
  Eigen::VectorXd sum_;         // #channels
  Eigen::MatrixXd product_sum_; // #channels by #channels
  std::int64_t frames_ = 0;
  std::int64_t left_out_ = 0;
};

// How many dimensions: a number, or the least that explains a share (0 to 1) of the variance.
struct PcaSize {
  int dimensions = 25;
  std::optional<double> share; // takes precedence
};

// The largest principal components, never more than there are channels. The basis' columns are
// orthonormal; in each the entry of largest magnitude (the first of equal ones) is positive. Throws
// InputError where there is no frame.
PcaModel fit_pca(const FrameStatistics& statistics, const PcaSize& size);

// Share of the variance that the model explains, 0 to 1; 1 where there is no variance.
double explained_share(const PcaModel& model);

} // namespace phonomime
