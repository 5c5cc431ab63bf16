// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/evaluate/measure_table.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace phonomime {

// Count, means and centred products of pairs (recorded, synthesised); two of them add up to that of
// all pairs together.
struct PairMoments {
  std::int64_t count = 0;
  double mean_recorded = 0.0, mean_synthesised = 0.0;
  double recorded_sq = 0.0, synthesised_sq = 0.0, product = 0.0; // sums of centred products

  void add(double recorded, double synthesised);
  void add(const PairMoments& other);

  // Pearson's; nothing where either does not vary.
  std::optional<double> correlation() const;
  // Standard deviation of the synthesis over that of the recording; nothing where that is 0.
  std::optional<double> deviation_ratio() const;
  // Standard error of the recorded mean; from two on.
  std::optional<double> recorded_mean_error() const;
};

// Values whose mean is wanted.
struct Tally {
  double sum = 0.0;
  std::int64_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  void add(const Tally& other) {
    sum += other.sum;
    count += other.count;
  }
  std::optional<double> mean() const {
    return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
  }
};

// Three curves of the lips.
enum class LipCurve : std::size_t { aperture, width, protrusion };
inline constexpr std::size_t kLipCurves = 3;

// All that the measures are computed from, of a sentence, a phoneme or a whole corpus: sums add up,
// so that a pooled value is exact. Errors are synthesis less recording, a group's error the
// Euclidean norm over its channels.
struct MeasureSums {
  std::int64_t sentences = 0;
  std::int64_t frames = 0;
  std::vector<double> group_error_sq;         // #groups: sum over frames of a group's squared error
  Tally lip_error_sq;                         // over frames and lip groups
  Tally largest_lip_error_sq;                 // over frames: the largest over lip groups
  Tally upper_face_dynamics;                  // over sentences
  Tally upper_face_dynamics_absolute;         // over sentences
  Tally velocity_error;                       // over frames and groups
  Tally lip_velocity_error;                   // over frames and lip groups
  std::array<PairMoments, kLipCurves> curves; // over frames
  std::array<PairMoments, kLipCurves> warped_curves; // over frames, see time_warping.h
  std::vector<double> aperture_speed_recorded, aperture_speed_synthesised; // one a frame
  std::vector<double> lip_speed_recorded, lip_speed_synthesised;           // one a frame
  Tally closed, closed_recorded, closed_kept;                              // rows, 1 = closed
  Tally contact, contact_recorded;                 // rows, 1 = within the range; see judge_contacts
  Tally contact_error;                             // rows
  Tally minimum_timing, minimum_timing_absolute;   // rows, s
  Tally jerk_at_joins, jerk_inside, jerk_recorded; // over frames
  Tally captured;                                  // over joins, 1 = captured

  // Throws InternalError where both have groups, and not as many.
  void add(const MeasureSums& other);
};

// The measures of sums, by the formulas of measure_table.h.
MeasureValues measure_values(const MeasureSums& sums);

} // namespace phonomime
