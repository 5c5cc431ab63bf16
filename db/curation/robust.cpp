// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/robust.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

RobustSpread robust_spread(std::vector<double> values) {
  const double median = quantile(values, 0.5);
  for (double& value : values) {
    value = std::abs(value - median);
  }
  return {.median = median, .sigma = 1.4826 * quantile(std::move(values), 0.5)};
}

} // namespace phonomime
