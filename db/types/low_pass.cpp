// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/low_pass.h"

#include "db/types/portable_sine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phonomime {
namespace {

// Modified Bessel function of the first kind, order 0, by its series.
double bessel_i0(double x) {
  const double quarter_square = 0.25 * x * x;
  double term = 1.0;
  double sum = 1.0;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= quarter_square / (static_cast<double>(k) * static_cast<double>(k));
    sum += term;
  }
  return sum;
}

} // namespace

LowPassKernel::LowPassKernel(double input_rate_hz, double output_rate_hz, const LowPassShape& shape)
    : bandwidth_(shape.cutoff * std::min(1.0, output_rate_hz / input_rate_hz)),
      half_width_(shape.half_width_frames / std::min(1.0, output_rate_hz / input_rate_hz)),
      kaiser_beta_(shape.kaiser_beta), window_at_0_(bessel_i0(shape.kaiser_beta)) {}

double LowPassKernel::operator()(double distance) const {
  const double share = distance / half_width_;
  if (std::abs(share) >= 1.0) {
    return 0.0;
  }
  const double crossings = bandwidth_ * distance;
  const double sinc = crossings == 0.0 ? 1.0 : sin_pi(crossings) / (std::numbers::pi * crossings);
  return sinc * bessel_i0(kaiser_beta_ * std::sqrt(1.0 - share * share)) / window_at_0_;
}

void low_pass_at(const FrameWindow& window, double position, const LowPassKernel& kernel,
                 Eigen::Ref<Eigen::RowVectorXd> result) {
  const Eigen::Index last = window.last;
  const auto frame = [&](Eigen::Index k) { return window.frames.row(k - window.first); };
  const auto first_tap = static_cast<Eigen::Index>(std::ceil(position - kernel.half_width()));
  const auto last_tap = static_cast<Eigen::Index>(std::floor(position + kernel.half_width()));
  // Deviations from the nearest frame are summed, not values: a constant stays exact.
  const auto base = frame(static_cast<Eigen::Index>(std::llround(position)));
  double weights = 0.0;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(base.cols());
  for (Eigen::Index tap = first_tap; tap <= last_tap; ++tap) {
    const double weight = kernel(static_cast<double>(tap) - position);
    weights += weight;
    if (tap < 0) {
      sum += weight * (2.0 * frame(0) - frame(std::min(-tap, last)) - base);
    } else if (tap > last) {
      sum += weight * (2.0 * frame(last) - frame(std::max(2 * last - tap, Eigen::Index{0})) - base);
    } else {
      sum += weight * (frame(tap) - base);
    }
  }
  result = base + sum / weights;
}

FrameMatrixD low_pass(const FrameMatrixD& frames, std::span<const double> positions,
                      const LowPassKernel& kernel) {
  FrameMatrixD result(static_cast<Eigen::Index>(positions.size()), frames.cols());
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    low_pass_at({frames, 0, frames.rows() - 1}, positions[static_cast<std::size_t>(k)], kernel,
                result.row(k));
  }
  return result;
}

} // namespace phonomime
