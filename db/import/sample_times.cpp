// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/sample_times.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace phonomime {

namespace {

constexpr double kFloatRounding = 1e-7; // times that went through a float

// Half of the range of time - frame / rate: the largest error off the best grid of this rate.
double half_range(std::span<const double> times_s, std::span<const std::size_t> frames,
                  double rate_hz) {
  double lowest = times_s[0];
  double highest = times_s[0];
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double start_s = times_s[i] - static_cast<double>(frames[i] - frames[0]) / rate_hz;
    lowest = std::min(lowest, start_s);
    highest = std::max(highest, start_s);
  }
  return (highest - lowest) / 2.0;
}

} // namespace

double median_step(std::span<const double> times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(times[i] - times[i - 1]);
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

double written_resolution(std::string_view number) {
  if (number.find_first_of("eE") != std::string_view::npos) {
    return 0.0;
  }
  const std::size_t point = number.find('.');
  const std::size_t digits = point == std::string_view::npos ? 0 : number.size() - point - 1;
  return std::pow(10.0, -static_cast<double>(digits));
}

FittedRate fit_rate(std::span<const double> times_s, std::span<const std::size_t> frames,
                    double resolution_s) {
  const auto count = static_cast<double>(times_s.size());
  double mean_time_s = 0.0;
  double mean_frame = 0.0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    mean_time_s += times_s[i] / count;
    mean_frame += static_cast<double>(frames[i]) / count;
  }
  double covariance = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double offset = static_cast<double>(frames[i]) - mean_frame;
    covariance += offset * (times_s[i] - mean_time_s);
    variance += offset * offset;
  }
  const double step_s = covariance / variance;

  FittedRate fit;
  fit.rate_hz = 1.0 / step_s;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double error_s =
        std::abs(times_s[i] - mean_time_s - (static_cast<double>(frames[i]) - mean_frame) * step_s);
    if (error_s > fit.largest_error_s) {
      fit.largest_error_s = error_s;
      fit.worst = i;
    }
  }
  const double rounding_s =
      resolution_s / 2.0 +
      kFloatRounding * std::max(std::abs(times_s.front()), std::abs(times_s.back()));
  const std::array<double, 2> nominal_hz = {std::round(fit.rate_hz),
                                            std::round(fit.rate_hz * 1.001) / 1.001};
  for (const double rate_hz : nominal_hz) {
    if (rate_hz > 0.0 && half_range(times_s, frames, rate_hz) <= rounding_s) {
      fit.rate_hz = rate_hz;
      break;
    }
  }
  return fit;
}

} // namespace phonomime
