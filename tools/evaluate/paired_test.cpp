// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/paired_test.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace phonomime {

namespace {

constexpr std::size_t kLargestExact = 50;

// The chance that the smaller sum of n ranks is at most `least`, both tails, when every sign is as
// likely as the other. Counts stay under 2^50, so that doubles hold them exactly.
double exact_p_value(std::size_t n, double least) {
  std::vector<double> ways(n * (n + 1) / 2 + 1, 0.0); // [sum] = sets of ranks with that sum
  ways[0] = 1.0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t sum = ways.size() - 1; sum >= rank; --sum) {
      ways[sum] += ways[sum - rank];
    }
  }
  const auto last = ways.begin() + static_cast<std::ptrdiff_t>(least) + 1;
  const double below = std::accumulate(ways.begin(), last, 0.0);
  return std::min(1.0, 2.0 * below / std::ldexp(1.0, static_cast<int>(n)));
}

double normal_p_value(double n, double least, double tied) {
  const double mean = n * (n + 1.0) / 4.0;
  const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - tied / 48.0;
  return std::erfc(std::abs(least - mean) / std::sqrt(variance) / std::numbers::sqrt2);
}

} // namespace

SignedRanks signed_rank_test(std::span<const double> differences) {
  std::vector<double> left;
  std::ranges::copy_if(differences, std::back_inserter(left), [](double d) { return d != 0.0; });
  std::ranges::sort(left, {}, [](double d) { return std::abs(d); });
  SignedRanks result;
  double tied = 0.0; // sum of t^3 - t over runs of t equal magnitudes
  for (std::size_t first = 0; first < left.size();) {
    std::size_t end = first;
    while (end < left.size() && std::abs(left[end]) == std::abs(left[first])) {
      ++end;
    }
    const double rank = static_cast<double>(first + 1 + end) / 2.0;
    for (std::size_t i = first; i < end; ++i) {
      (left[i] > 0.0 ? result.positive : result.negative) += rank;
    }
    const auto run = static_cast<double>(end - first);
    tied += run * run * run - run;
    first = end;
  }
  if (left.empty()) {
    return result;
  }
  const double least = std::min(result.positive, result.negative);
  result.p_value = tied == 0.0 && left.size() <= kLargestExact
                       ? exact_p_value(left.size(), least)
                       : normal_p_value(static_cast<double>(left.size()), least, tied);
  return result;
}

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p_values[i]; });
  std::vector<double> adjusted(p_values.size(), 1.0);
  double largest = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto left = static_cast<double>(order.size() - k);
    largest = std::max(largest, std::min(1.0, left * p_values[order[k]]));
    adjusted[order[k]] = largest;
  }
  return adjusted;
}

} // namespace phonomime
