// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/blend.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace phonomime {

namespace {

constexpr double kMostGain = 2.0;

// One side of a gaussian in frames, its middle first, as sums to 1 with both sides. By halving
// steps instead of exp(), which differs between machines: a binomial of the same deviation.
std::vector<double> binomial_window(double deviation_frames) {
  // n coin tosses have the deviation sqrt(n) / 2.
  const auto half = static_cast<std::size_t>(
      std::max(1.0, std::round(2.0 * deviation_frames * deviation_frames)));
  std::vector<double> row(2 * half + 1, 0.0);
  row[0] = 1.0;
  for (std::size_t toss = 0; toss < 2 * half; ++toss) {
    for (std::size_t i = toss + 1; i > 0; --i) {
      row[i] = 0.5 * (row[i] + row[i - 1]);
    }
    row[0] *= 0.5;
  }
  return {row.begin() + static_cast<std::ptrdiff_t>(half), row.end()};
}

FrameMatrixD smoothed(const FrameMatrixD& motion, const std::vector<double>& window) {
  const auto last = motion.rows() - 1;
  FrameMatrixD result = window[0] * motion;
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    for (std::size_t i = 1; i < window.size(); ++i) {
      const auto away = static_cast<Eigen::Index>(i);
      result.row(k) += window[i] * (motion.row(std::max<Eigen::Index>(k - away, 0)) +
                                    motion.row(std::min(k + away, last)));
    }
  }
  return result;
}

struct Parts {
  Eigen::RowVectorXd pose; // mean over time
  FrameMatrixD slow, fast;
};

Parts part(const FrameMatrixD& motion, const std::vector<double>& window) {
  Parts parts;
  parts.slow = smoothed(motion, window);
  parts.fast = motion - parts.slow;
  parts.pose = parts.slow.colwise().mean();
  parts.slow.rowwise() -= parts.pose;
  return parts;
}

double gain(double members, double own, double liveliness) {
  if (own <= 0.0 || members <= own) {
    return 1.0; // nothing is lost
  }
  const double root = std::sqrt(members / own);
  return std::min(kMostGain, 1.0 + liveliness * (root - 1.0));
}

} // namespace

FrameMatrixD blend_motions(std::span<const FrameMatrixD> motions, const FrameMatrixD& expected,
                           double rate_hz, const BlendOptions& options) {
  FrameMatrixD mean = motions.front();
  for (const FrameMatrixD& motion : motions.subspan(1)) {
    mean += motion;
  }
  if (motions.size() == 1) {
    return mean;
  }
  mean /= static_cast<double>(motions.size());
  if (expected.rows() > 0) {
    mean = (1.0 - options.expected_share) * mean + options.expected_share * expected;
  }
  const std::vector<double> window = binomial_window(options.cut_off_s * rate_hz);
  const Parts own = part(mean, window);
  Eigen::RowVectorXd slow = Eigen::RowVectorXd::Zero(mean.cols());
  double fast = 0.0;
  for (const FrameMatrixD& motion : motions) {
    const Parts parts = part(motion, window);
    slow += parts.slow.colwise().squaredNorm();
    fast += parts.fast.squaredNorm();
  }
  const auto count = static_cast<double>(motions.size());
  FrameMatrixD result = gain(fast / count, own.fast.squaredNorm(), options.liveliness) * own.fast;
  for (Eigen::Index c = 0; c < result.cols(); ++c) {
    result.col(c) +=
        gain(slow[c] / count, own.slow.col(c).squaredNorm(), options.liveliness) * own.slow.col(c);
  }
  result.rowwise() += own.pose;
  return result;
}

} // namespace phonomime
