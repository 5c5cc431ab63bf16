// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/lip_events.h"

#include "db/types/percentile.h"
#include "db/types/row_frames.h"
#include "synth/pipeline/closures.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

// The first frame of a range at which a curve is least among the usable ones.
std::optional<std::int64_t> least_frame(std::span<const double> curve,
                                        std::span<const std::uint8_t> usable, std::int64_t first,
                                        std::int64_t end) {
  std::optional<std::int64_t> least;
  for (std::int64_t k = std::max<std::int64_t>(first, 0);
       k < std::min(end, static_cast<std::int64_t>(curve.size())); ++k) {
    if (usable[k] != 0 && (!least || curve[k] < curve[*least])) {
      least = k;
    }
  }
  return least;
}

} // namespace

LipDemand lip_demand(const Phoneme& phoneme) {
  if (asks_for_closure(phoneme)) {
    return LipDemand::closure;
  }
  return phoneme.name == "f" || phoneme.name == "v" ? LipDemand::contact : LipDemand::none;
}

std::vector<LipEvent> find_lip_events(std::span<const TimedPhoneme> rows,
                                      std::span<const double> recorded_mm,
                                      std::span<const double> synthesised_mm,
                                      std::span<const std::uint8_t> usable, double rate_hz) {
  const std::vector<FrameRange> ranges = row_frames(rows, rate_hz);
  const auto reach = static_cast<std::int64_t>(std::lround(kMinimumReach_s * rate_hz));
  std::vector<LipEvent> events;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const LipDemand demand = lip_demand(rows[row].phoneme);
    if (demand == LipDemand::none) {
      continue;
    }
    const FrameRange& range = ranges[row];
    const auto recorded = least_frame(recorded_mm, usable, range.first, range.end());
    if (!recorded) {
      continue;
    }
    const auto synthesised = least_frame(synthesised_mm, usable, range.first, range.end());
    const auto recorded_minimum =
        least_frame(recorded_mm, usable, range.first - reach, range.end() + reach);
    const auto synthesised_minimum =
        least_frame(synthesised_mm, usable, range.first - reach, range.end() + reach);
    events.push_back(
        {.row = static_cast<std::int32_t>(row),
         .phoneme = rows[row].phoneme.name,
         .demand = demand,
         .recorded_aperture_mm = recorded_mm[*recorded],
         .synthesised_aperture_mm = synthesised_mm[*synthesised],
         .timing_s = static_cast<double>(*synthesised_minimum - *recorded_minimum) / rate_hz});
  }
  return events;
}

std::map<std::string, ContactRange> contact_ranges(std::span<const LipEvent> events) {
  std::map<std::string, std::vector<double>> apertures_mm;
  for (const LipEvent& event : events) {
    if (event.demand == LipDemand::contact) {
      apertures_mm[event.phoneme].push_back(event.recorded_aperture_mm);
    }
  }
  std::map<std::string, ContactRange> ranges;
  for (const auto& [phoneme, values] : apertures_mm) {
    if (values.size() >= kLeastContactRows) {
      ranges[phoneme] = {*percentile(values, 0.1), *percentile(values, 0.9),
                         static_cast<std::int64_t>(values.size())};
    }
  }
  return ranges;
}

} // namespace phonomime
