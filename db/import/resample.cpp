// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/resample.h"

#include "db/types/low_pass.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

constexpr double kSameTime_frames = 1e-6; // recorded frames: rounding of times

// Side lobes under -70 dB.
constexpr LowPassShape kLowPass{.cutoff = 0.9, .half_width_frames = 10.0, .kaiser_beta = 7.0};

bool goes_down(const SourceClock& recorded, double rate_hz) {
  return rate_hz < recorded.rate_hz * (1.0 - 1e-9);
}

// Time of new frame k in recorded frames, rounded onto a recorded frame where it is within
// rounding.
double position(Eigen::Index k, const SourceClock& recorded, double rate_hz) {
  const double at = (static_cast<double>(k) / rate_hz - recorded.start_s) * recorded.rate_hz;
  const double nearest = std::round(at);
  return std::abs(at - nearest) < kSameTime_frames ? nearest : at;
}

// Slopes (per frame) of the monotone cubic of Fritsch and Butland: the harmonic mean of the steps
// to either side, 0 at an extremum; one-sided at the ends.
FrameMatrixD monotone_slopes(const FrameMatrixD& y) {
  const Eigen::Index n = y.rows();
  FrameMatrixD slopes = FrameMatrixD::Zero(n, y.cols());
  if (n < 2) {
    return slopes;
  }
  slopes.row(0) = y.row(1) - y.row(0);
  slopes.row(n - 1) = y.row(n - 1) - y.row(n - 2);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    for (Eigen::Index c = 0; c < y.cols(); ++c) {
      const double before = y(i, c) - y(i - 1, c);
      const double after = y(i + 1, c) - y(i, c);
      slopes(i, c) = before * after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
    }
  }
  return slopes;
}

FrameMatrixD upsample(const FrameMatrixD& y, const SourceClock& recorded, double rate_hz,
                      Eigen::Index count) {
  const FrameMatrixD slopes = monotone_slopes(y);
  FrameMatrixD result(count, y.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const double at =
        std::clamp(position(k, recorded, rate_hz), 0.0, static_cast<double>(y.rows() - 1));
    const auto i = static_cast<Eigen::Index>(std::floor(at));
    const double b = at - static_cast<double>(i);
    if (b == 0.0) {
      result.row(k) = y.row(i);
      continue;
    }
    const double a = 1.0 - b; // the cubic Hermite basis in a and b
    result.row(k) = a * a * (1.0 + 2.0 * b) * y.row(i) + b * b * (1.0 + 2.0 * a) * y.row(i + 1) +
                    a * a * b * slopes.row(i) - a * b * b * slopes.row(i + 1);
  }
  return result;
}

FrameMatrixD downsample(const FrameMatrixD& y, const SourceClock& recorded, double rate_hz,
                        Eigen::Index count) {
  std::vector<double> positions;
  for (Eigen::Index k = 0; k < count; ++k) {
    positions.push_back(
        std::clamp(position(k, recorded, rate_hz), 0.0, static_cast<double>(y.rows() - 1)));
  }
  return low_pass(y, positions, LowPassKernel(recorded.rate_hz, rate_hz, kLowPass));
}

} // namespace

FrameMatrixD resample(const FrameMatrixD& frames, const SourceClock& recorded, double rate_hz,
                      Eigen::Index count) {
  return goes_down(recorded, rate_hz) ? downsample(frames, recorded, rate_hz, count)
                                      : upsample(frames, recorded, rate_hz, count);
}

std::vector<HeadPose> resample_head(const std::vector<HeadPose>& head, const SourceClock& recorded,
                                    double rate_hz, Eigen::Index count) {
  FrameMatrixD channels(static_cast<Eigen::Index>(head.size()), 7);
  for (std::size_t k = 0; k < head.size(); ++k) {
    channels.row(static_cast<Eigen::Index>(k)) << head[k].translation_mm.transpose(),
        head[k].rotation.coeffs().transpose();
  }
  const FrameMatrixD resampled = resample(channels, recorded, rate_hz, count);
  std::vector<HeadPose> result(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < result.size(); ++k) {
    const auto row = resampled.row(static_cast<Eigen::Index>(k));
    result[k].translation_mm = row.head<3>().transpose();
    result[k].rotation.coeffs() = row.tail<4>().transpose();
    result[k].rotation.normalize();
  }
  return result;
}

std::vector<std::uint8_t> resample_marks(const std::vector<std::uint8_t>& marks,
                                         const SourceClock& recorded, double rate_hz,
                                         Eigen::Index count) {
  const auto last = static_cast<double>(marks.size()) - 1.0;
  const double reach = goes_down(recorded, rate_hz) ? recorded.rate_hz / rate_hz : 0.0;
  std::vector<std::uint8_t> result(static_cast<std::size_t>(count), 0);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double at = std::clamp(position(k, recorded, rate_hz), 0.0, last);
    const auto from = static_cast<std::size_t>(std::floor(std::max(0.0, at - reach)));
    const auto to = static_cast<std::size_t>(std::ceil(std::min(last, at + reach)));
    for (std::size_t j = from; j <= to; ++j) {
      result[static_cast<std::size_t>(k)] |= marks[j];
    }
  }
  return result;
}

} // namespace phonomime
