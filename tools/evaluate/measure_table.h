// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace phonomime {

// Every measure of an evaluation, in the order of its tables.
enum class Measure : std::size_t {
  squared_error,
  rmse,
  lip_rmse,
  lip_vertex_error,
  lip_vertex_error_root,
  upper_face_dynamics,
  upper_face_dynamics_absolute,
  velocity_error,
  lip_velocity_error,
  aperture_correlation,
  width_correlation,
  protrusion_correlation,
  aperture_correlation_warped,
  width_correlation_warped,
  protrusion_correlation_warped,
  aperture_deviation_ratio,
  width_deviation_ratio,
  aperture_speed_ratio,
  lip_speed_ratio,
  closure_recall,
  closure_recall_recorded,
  closure_kept,
  contact_share,
  contact_share_recorded,
  contact_error,
  minimum_timing_error,
  minimum_timing_bias,
  jerk_at_joins,
  jerk_inside_nodes,
  jerk_ratio,
  jerk_recorded,
  captured_joins,
};
inline constexpr std::size_t kMeasureCount = static_cast<std::size_t>(Measure::captured_joins) + 1;

// What is good: small, large, near 1 or near 0; `none` where the measure only describes.
enum class Aim { small, large, near_one, near_zero, none };

// What a measure is, once for text, JSON and HTML.
struct MeasureInfo {
  std::string_view id;    // as in JSON and CSV: "lip_rmse"
  std::string_view label; // for people: "lip RMSE"
  std::string_view unit;  // of a layout of markers: "mm^2"; "1" where it has none
  Aim aim;
  int decimals;             // as tables show it
  std::string_view formula; // how it is computed, in words and symbols
  std::string_view mask;    // over which frames, rows or joins
};
const MeasureInfo& info(Measure measure);

// The unit in a layout of that kind: weights have no millimetres, "mm/s" is "1/s" there.
std::string_view unit_of(Measure measure, LayoutKind kind);

// The measure of an id, or nothing.
std::optional<Measure> find_measure(std::string_view id);

// All measures, in order.
std::array<Measure, kMeasureCount> all_measures();

// The measures that a first table shows, with names that fit above a column.
struct Headline {
  Measure measure;
  std::string_view label;
};
std::span<const Headline> headlines();

// One value a measure; nothing where it has no meaning (a layout of weights has no aperture, a
// sentence without /p b m/ no closure), which is never the same as 0.
class MeasureValues {
public:
  std::optional<double>& operator[](Measure measure) {
    return values_[static_cast<std::size_t>(measure)];
  }
  const std::optional<double>& operator[](Measure measure) const {
    return values_[static_cast<std::size_t>(measure)];
  }
  bool operator==(const MeasureValues&) const = default;

private:
  std::array<std::optional<double>, kMeasureCount> values_ = {};
};

// How far a value is from what is good, so that smaller is better: the value, its negative, or its
// distance from 1 or 0. Nothing for a measure that only describes.
std::optional<double> badness(Measure measure, double value);

} // namespace phonomime
