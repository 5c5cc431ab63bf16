// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace phonomime {

// Median and spread of a quantity, of its binary logarithm.
struct LogSpread {
  std::int64_t count = 0;
  double median = 0.0; // of log2(value)
  double sigma = 0.0;  // 1.4826 times the median absolute deviation: the sigma of a normal law
};

// Counts of positive values in bins of 1/16 octave from 2^-10 to 2^20: a robust measure of a whole
// corpus in little memory, whose sums do not depend on the order of adding. Values below (zero too)
// are not counted, values above count in the last bin.
class LogHistogram {
public:
  void add(double value);
  void add(const LogHistogram& other);

  // To the width of a bin; zeros where nothing was counted.
  LogSpread spread() const;

  // The value that a share (0 to 1) of those counted does not exceed, to the width of a bin; 0
  // where nothing was counted.
  double quantile(double share) const;

private:
  static constexpr int kBinsPerOctave = 16;
  static constexpr int kLowestOctave = -10;
  static constexpr int kOctaves = 30;
  std::array<std::uint32_t, kBinsPerOctave * kOctaves> counts_{};
};

} // namespace phonomime
