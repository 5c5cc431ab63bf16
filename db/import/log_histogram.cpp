// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/log_histogram.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

void LogHistogram::add(double value) {
  if (!(value > 0.0)) {
    return;
  }
  const double bin = std::floor((std::log2(value) - kLowestOctave) * kBinsPerOctave);
  if (bin >= 0.0) {
    const double last = static_cast<double>(counts_.size()) - 1.0;
    ++counts_[static_cast<std::size_t>(std::min(bin, last))];
  }
}

void LogHistogram::add(const LogHistogram& other) {
  for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
    counts_[bin] += other.counts_[bin];
  }
}

LogSpread LogHistogram::spread() const {
  LogSpread result;
  for (const std::uint32_t count : counts_) {
    result.count += count;
  }
  if (result.count == 0) {
    return result;
  }
  std::int64_t seen = 0;
  std::size_t middle = 0;
  while ((seen += counts_[middle]) * 2 < result.count) {
    ++middle;
  }
  // Deviations from the middle bin, smallest first.
  seen = counts_[middle];
  std::size_t reach = 0;
  while (seen * 2 < result.count) {
    ++reach;
    seen += middle >= reach ? counts_[middle - reach] : 0;
    seen += middle + reach < counts_.size() ? counts_[middle + reach] : 0;
  }
  constexpr double kNormal = 1.4826;
  result.median = (static_cast<double>(middle) + 0.5) / kBinsPerOctave + kLowestOctave;
  result.sigma = kNormal * std::max(0.5, static_cast<double>(reach)) / kBinsPerOctave;
  return result;
}

double LogHistogram::quantile(double share) const {
  std::int64_t total = 0;
  for (const std::uint32_t count : counts_) {
    total += count;
  }
  std::int64_t seen = 0;
  for (std::size_t bin = 0; total > 0 && bin < counts_.size(); ++bin) {
    seen += counts_[bin];
    if (static_cast<double>(seen) >= share * static_cast<double>(total)) {
      return std::exp2(static_cast<double>(bin + 1) / kBinsPerOctave + kLowestOctave);
    }
  }
  return 0.0;
}

} // namespace phonomime
