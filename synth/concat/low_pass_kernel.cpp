// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/low_pass_kernel.h"

#include "synth/concat/portable_sine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phonomime {
namespace {

constexpr double kZeroCrossings = 6.0;
constexpr double kKaiserBeta = 5.0;

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

LowPassKernel::LowPassKernel(double input_rate_hz, double output_rate_hz)
    : bandwidth_(std::min(1.0, output_rate_hz / input_rate_hz)),
      half_width_(kZeroCrossings / bandwidth_), window_at_0_(bessel_i0(kKaiserBeta)) {}

double LowPassKernel::operator()(double distance) const {
  const double share = distance / half_width_;
  if (std::abs(share) >= 1.0) {
    return 0.0;
  }
  const double crossings = bandwidth_ * distance;
  const double sinc = crossings == 0.0 ? 1.0 : sin_pi(crossings) / (std::numbers::pi * crossings);
  return sinc * bessel_i0(kKaiserBeta * std::sqrt(1.0 - share * share)) / window_at_0_;
}

} // namespace phonomime
