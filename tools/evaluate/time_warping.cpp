// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/time_warping.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace phonomime {

namespace {

std::optional<std::vector<double>> standardised(std::span<const double> curve) {
  double mean = 0.0;
  for (const double value : curve) {
    mean += value / static_cast<double>(curve.size());
  }
  double variance = 0.0;
  for (const double value : curve) {
    variance += (value - mean) * (value - mean) / static_cast<double>(curve.size());
  }
  if (!(variance > 1e-24 * mean * mean)) {
    return std::nullopt;
  }
  std::vector<double> standard;
  standard.reserve(curve.size());
  for (const double value : curve) {
    standard.push_back((value - mean) / std::sqrt(variance));
  }
  return standard;
}

// Where the best path to a pair comes from.
enum class Step : char { none, both, recorded, synthesised };

// The samples of the synthesis that one sample of the recording may be matched with, and the best
// path to each of these pairs.
struct WarpRow {
  std::size_t begin = 0;
  std::vector<double> cost;
  std::vector<Step> step;

  bool holds(std::size_t j) const { return j >= begin && j < begin + cost.size(); }
};

std::vector<WarpRow> best_paths(const std::vector<double>& recorded,
                                const std::vector<double>& synthesised,
                                std::span<const std::int64_t> frames, std::int64_t band_frames) {
  std::vector<WarpRow> rows(recorded.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    WarpRow& row = rows[i];
    const auto low = std::ranges::lower_bound(frames, frames[i] - band_frames);
    const auto high = std::ranges::upper_bound(frames, frames[i] + band_frames);
    row.begin = static_cast<std::size_t>(low - frames.begin());
    const auto end = static_cast<std::size_t>(high - frames.begin());
    for (std::size_t j = row.begin; j < end; ++j) {
      double best = i == 0 && j == 0 ? 0.0 : std::numeric_limits<double>::infinity();
      Step step = Step::none;
      const auto consider = [&](const WarpRow& from, std::size_t column, Step by) {
        if (from.holds(column) && from.cost[column - from.begin] < best) {
          best = from.cost[column - from.begin];
          step = by;
        }
      };
      if (i > 0 && j > 0) {
        consider(rows[i - 1], j - 1, Step::both);
      }
      if (i > 0) {
        consider(rows[i - 1], j, Step::recorded);
      }
      if (j > 0) {
        consider(row, j - 1, Step::synthesised);
      }
      const double off = recorded[i] - synthesised[j];
      row.cost.push_back(best + off * off);
      row.step.push_back(step);
    }
  }
  return rows;
}

} // namespace

std::vector<double> warp_onto(std::span<const double> recorded, std::span<const double> synthesised,
                              std::span<const std::int64_t> frames, std::int64_t band_frames) {
  const std::size_t n = recorded.size();
  const auto standard_recorded = standardised(recorded);
  const auto standard_synthesised = standardised(synthesised);
  if (!standard_recorded || !standard_synthesised) {
    return {synthesised.begin(), synthesised.end()};
  }
  const std::vector<WarpRow> rows =
      best_paths(*standard_recorded, *standard_synthesised, frames, band_frames);
  std::vector<double> sum(n, 0.0);
  std::vector<int> count(n, 0);
  for (std::size_t i = n - 1, j = n - 1;;) {
    sum[i] += synthesised[j];
    ++count[i];
    const Step step = rows[i].step[j - rows[i].begin];
    if (step == Step::none) {
      break;
    }
    i -= step == Step::synthesised ? 0 : 1;
    j -= step == Step::recorded ? 0 : 1;
  }
  for (std::size_t i = 0; i < n; ++i) {
    sum[i] /= count[i];
  }
  return sum;
}

} // namespace phonomime
