// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/weight_filter.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace phonomime {

FrameMatrixD filter_weights(const FrameMatrixD& weights, double rate_hz, double width_s) {
  if (!(width_s >= 0.0) || std::isinf(width_s)) {
    throw UsageError({.what = "the filter's width is out of range",
                      .expected = "seconds, from 0 (none) on",
                      .got = format_number(width_s)});
  }
  const double width = width_s * rate_hz; // in frames
  const auto reach = static_cast<Eigen::Index>(
      std::min(std::floor(4.0 * width), static_cast<double>(weights.rows())));
  if (reach == 0) {
    return weights;
  }
  std::vector<double> bell(static_cast<std::size_t>(reach) + 1);
  for (std::size_t k = 0; k < bell.size(); ++k) {
    const double share = static_cast<double>(k) / width;
    bell[k] = std::exp(-0.5 * share * share);
  }
  FrameMatrixD result(weights.rows(), weights.cols());
  for (Eigen::Index t = 0; t < weights.rows(); ++t) {
    // Deviations are summed, not values: a constant stays exact.
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(weights.cols());
    double total = 0.0;
    const Eigen::Index last = std::min(t + reach, weights.rows() - 1);
    for (Eigen::Index k = std::max<Eigen::Index>(t - reach, 0); k <= last; ++k) {
      const double share = bell[static_cast<std::size_t>(std::abs(k - t))];
      sum += share * (weights.row(k) - weights.row(t));
      total += share;
    }
    result.row(t) = weights.row(t) + sum / total;
  }
  return result;
}

} // namespace phonomime
