// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

namespace phonomime {

// Wilcoxon's signed-rank test of paired differences, two-sided. Zeros are dropped, equal magnitudes
// share their mean rank; exact up to 50 differences of distinct magnitudes, else by the normal
// approximation with correction for ties.
struct SignedRanks {
  double p_value = 1.0;                  // 1 where no difference is left
  double positive = 0.0, negative = 0.0; // sums of ranks
};
SignedRanks signed_rank_test(std::span<const double> differences);

// Holm's adjustment of p-values that are looked at together: the chance of one false alarm or more
// among all stays under the level at which the adjusted values are judged.
std::vector<double> holm_adjusted(std::span<const double> p_values);

} // namespace phonomime
