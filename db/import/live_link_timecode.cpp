// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/live_link_timecode.h"

#include "db/import/sample_times.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace phonomime {

namespace {

constexpr int kSecondsPerDay = 24 * 60 * 60;
constexpr double kLiveLinkTicks = 60.0;
constexpr std::array<double, 4> kOtherTicks = {24.0, 25.0, 30.0, 50.0};

// Frames that steps longer than the median one leave out.
double dropped_frames(std::span<const Timecode> timecodes, double ticks_per_second) {
  const std::vector<double> times_s = elapsed_s(timecodes, ticks_per_second);
  const double step_s = median_step(times_s);
  double dropped = 0.0;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    dropped += std::max(0.0, std::round((times_s[i] - times_s[i - 1]) / step_s) - 1.0);
  }
  return dropped;
}

} // namespace

std::optional<Timecode> parse_timecode(std::string_view text) {
  const std::vector<std::string_view> parts = split_fields(text, ':');
  if (parts.size() != 4) {
    return std::nullopt;
  }
  const std::optional<long> hours = parse_integer(parts[0]);
  const std::optional<long> minutes = parse_integer(parts[1]);
  const std::optional<long> seconds = parse_integer(parts[2]);
  const std::optional<double> ticks = parse_number(parts[3]);
  const auto within = [](std::optional<long> value, long limit) {
    return value && *value >= 0 && *value < limit;
  };
  if (!within(hours, 24) || !within(minutes, 60) || !within(seconds, 60) || !ticks ||
      *ticks < 0.0 || *ticks >= kLiveLinkTicks) {
    return std::nullopt;
  }
  return Timecode{static_cast<int>(*hours * 3600 + *minutes * 60 + *seconds), *ticks,
                  written_resolution(parts[3])};
}

std::vector<double> elapsed_s(std::span<const Timecode> timecodes, double ticks_per_second) {
  std::vector<double> times_s;
  long day_start_s = 0;
  for (std::size_t i = 0; i < timecodes.size(); ++i) {
    const Timecode& now = timecodes[i];
    if (i > 0 && timecodes[i - 1].second_of_day - now.second_of_day > kSecondsPerDay / 2) {
      day_start_s += kSecondsPerDay;
    }
    const auto whole_s =
        static_cast<double>(day_start_s + now.second_of_day - timecodes[0].second_of_day);
    times_s.push_back(whole_s + (now.ticks - timecodes[0].ticks) / ticks_per_second);
  }
  return times_s;
}

double ticks_per_second(std::span<const Timecode> timecodes) {
  double largest = 0.0;
  int changes = 0;
  for (std::size_t i = 0; i < timecodes.size(); ++i) {
    largest = std::max(largest, timecodes[i].ticks);
    changes += i > 0 && timecodes[i].second_of_day != timecodes[i - 1].second_of_day ? 1 : 0;
  }
  if (changes < 2) {
    return kLiveLinkTicks;
  }
  double best = kLiveLinkTicks;
  double fewest = dropped_frames(timecodes, kLiveLinkTicks) / 2.0;
  for (const double ticks : kOtherTicks) {
    if (largest < ticks) {
      const double dropped = dropped_frames(timecodes, ticks);
      if (dropped < fewest) {
        best = ticks;
        fewest = dropped;
      }
    }
  }
  return best;
}

} // namespace phonomime
