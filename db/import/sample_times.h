// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace phonomime {

// The median of the steps between successive times. At least two times.
double median_step(std::span<const double> times);

// The size of the last digit after the decimal point as written: "0.04" gives 0.01, "3" gives 1.
// Numbers with an exponent give 0.
double written_resolution(std::string_view number);

// A rate fitted to times, and how far off the grid the worst of them lies.
struct FittedRate {
  double rate_hz = 0.0;
  double largest_error_s = 0.0;
  std::size_t worst = 0; // into `times`
};

// Fits frame numbers (increasing, at least two) to their times by least squares. Where a nominal
// rate (a whole number of frames a second, or N * 1000 / 1001) explains all times to within their
// rounding, it is that rate.
FittedRate fit_rate(std::span<const double> times_s, std::span<const std::size_t> frames,
                    double resolution_s);

} // namespace phonomime
