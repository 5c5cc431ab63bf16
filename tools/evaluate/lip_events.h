// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/lip_measures.h"
#include "db/types/phoneme_set.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

// What the lips have to do for a phoneme.
enum class LipDemand { none, closure, contact };

// closure for /p b m/, contact (lower lip to teeth) for /f v/.
LipDemand lip_demand(const Phoneme& phoneme);

// A row of /p b m f v/ in the recording and in the synthesis.
struct LipEvent {
  std::int32_t row = 0; // of ImportedSentence::rows
  std::string phoneme;
  LipDemand demand = LipDemand::closure;
  double recorded_aperture_mm = 0.0; // the least over the row's frames
  double synthesised_aperture_mm = 0.0;
  double timing_s = 0.0; // time of the least aperture, synthesis less recording; sought from
                         // kMinimumReach_s before the row to as long after it
  bool recorded_closed() const { return recorded_aperture_mm < kClosedAperture_mm; }
  bool synthesised_closed() const { return synthesised_aperture_mm < kClosedAperture_mm; }
};
inline constexpr double kMinimumReach_s = 0.05;

// The events of a sentence in order of row. `recorded_mm`, `synthesised_mm`: #frames, the aperture;
// `usable`: #frames, 0 where the recording has a gap. A row without a usable frame is left out.
std::vector<LipEvent> find_lip_events(std::span<const TimedPhoneme> rows,
                                      std::span<const double> recorded_mm,
                                      std::span<const double> synthesised_mm,
                                      std::span<const std::uint8_t> usable, double rate_hz);

// How far the lips open at least for a phoneme in the recordings: the 10th and the 90th percentile
// of the least aperture over its rows.
struct ContactRange {
  double low_mm = 0.0;
  double high_mm = 0.0;
  std::int64_t rows = 0;
  bool holds(double aperture_mm) const { return aperture_mm >= low_mm && aperture_mm <= high_mm; }
};

// By phoneme, over the events whose demand is contact; a phoneme with fewer rows has none.
inline constexpr std::size_t kLeastContactRows = 10;
std::map<std::string, ContactRange> contact_ranges(std::span<const LipEvent> events);

} // namespace phonomime
