// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace phonomime {

// Middle and width of numbers, whatever a few of them are: the median, and 1.4826 times the median
// distance from it, which is the standard deviation of a normal law.
struct RobustSpread {
  double median = 0.0;
  double sigma = 0.0;
};
RobustSpread robust_spread(std::vector<double> values); // at least one

// The value that a share (0 to 1) of `values` (at least one) does not exceed.
double quantile(std::vector<double> values, double share);

} // namespace phonomime
