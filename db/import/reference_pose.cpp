// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/reference_pose.h"

#include <algorithm>
#include <vector>

namespace phonomime {

namespace {

// The lower median of each column.
Eigen::RowVectorXd column_medians(const FrameMatrixD& frames) {
  Eigen::RowVectorXd medians(frames.cols());
  std::vector<double> column(static_cast<std::size_t>(frames.rows()));
  const auto middle = column.begin() + (frames.rows() - 1) / 2;
  for (Eigen::Index c = 0; c < frames.cols(); ++c) {
    for (Eigen::Index k = 0; k < frames.rows(); ++k) {
      column[static_cast<std::size_t>(k)] = frames(k, c);
    }
    std::nth_element(column.begin(), middle, column.end());
    medians(c) = *middle;
  }
  return medians;
}

} // namespace

Eigen::Index frame_nearest_to_median(const FrameMatrix& frames, const HeadAnchor& anchor,
                                     Scale scale) {
  constexpr int kMostRounds = 5;
  const FrameMatrixD recorded = frames.cast<double>();
  Eigen::Index nearest = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd reference = centred_on_anchor(recorded.row(nearest).transpose(), anchor);
    const HeadFree still = remove_head(recorded, anchor, reference, scale);
    const FrameMatrixD& local = still.found ? still.local : recorded;
    const Eigen::RowVectorXd median = column_medians(local);
    const Eigen::Index before = nearest;
    (local.rowwise() - median).rowwise().squaredNorm().minCoeff(&nearest);
    if (nearest == before) {
      break;
    }
  }
  return nearest;
}

} // namespace phonomime
