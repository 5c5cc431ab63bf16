// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/measure_table.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

constexpr std::string_view kSpeech = "frames within the speech";
constexpr std::string_view kBilabials = "rows of /p b m/";
constexpr std::string_view kLabiodentals = "rows of /f v/";
constexpr std::string_view kLipRows = "rows of /p b m f v/, 0.05 s more on either side";
constexpr std::string_view kThirds = "third differences within the speech and outside of silence";

// s is the synthesis and o the recording; |.| is the Euclidean norm over a group's channels.
constexpr std::array<MeasureInfo, kMeasureCount> kTable = {{
    {"squared_error", "squared error (E13)", "mm^2", Aim::small, 2,
     "mean over frames and groups of |s - o|^2 (E13; its sum over sentences is E12)", kSpeech},
    {"rmse", "RMSE", "mm", Aim::small, 3, "root of the mean over frames and groups of |s - o|^2",
     kSpeech},
    {"lip_rmse", "lip RMSE", "mm", Aim::small, 3,
     "root of the mean over frames and groups of the lips of |s - o|^2", kSpeech},
    {"lip_vertex_error", "lip vertex error", "mm^2", Aim::small, 2,
     "mean over frames of the largest |s - o|^2 over the groups of the lips", kSpeech},
    {"lip_vertex_error_root", "lip vertex error, root", "mm", Aim::small, 3,
     "root of the lip vertex error", kSpeech},
    {"upper_face_dynamics", "upper-face dynamics (FDD)", "mm^2", Aim::near_zero, 3,
     "mean over groups of brows, eyelids and forehead of std(|o - r|^2) - std(|s - r|^2), std over "
     "time, r the reference pose; above 0: less motion than recorded",
     kSpeech},
    {"upper_face_dynamics_absolute", "upper-face dynamics, absolute", "mm^2", Aim::small, 3,
     "mean over groups of brows, eyelids and forehead of |std(|o - r|^2) - std(|s - r|^2)|",
     kSpeech},
    {"velocity_error", "velocity error", "mm/s", Aim::small, 2,
     "mean over frames and groups of |s' - o'|, x' = (x[k] - x[k-1]) rate", kSpeech},
    {"lip_velocity_error", "lip velocity error", "mm/s", Aim::small, 2,
     "mean over frames and groups of the lips of |s' - o'|", kSpeech},
    {"aperture_correlation", "aperture correlation", "1", Aim::large, 3,
     "Pearson correlation of the aperture, height of the inner upper over the inner lower lip",
     kSpeech},
    {"width_correlation", "width correlation", "1", Aim::large, 3,
     "Pearson correlation of the distance of the mouth's corners", kSpeech},
    {"protrusion_correlation", "protrusion correlation", "1", Aim::large, 3,
     "Pearson correlation of the mean forward position of the lips", kSpeech},
    {"aperture_correlation_warped", "aperture correlation, warped", "1", Aim::large, 3,
     "Pearson correlation of the aperture after dynamic time warping of s onto o, by 0.15 s at "
     "most",
     kSpeech},
    {"width_correlation_warped", "width correlation, warped", "1", Aim::large, 3,
     "Pearson correlation of the width after dynamic time warping of s onto o, by 0.15 s at most",
     kSpeech},
    {"protrusion_correlation_warped", "protrusion correlation, warped", "1", Aim::large, 3,
     "Pearson correlation of the protrusion after dynamic time warping of s onto o, by 0.15 s at "
     "most",
     kSpeech},
    {"aperture_deviation_ratio", "aperture deviation ratio", "1", Aim::near_one, 3,
     "standard deviation over time of the aperture, s / o", kSpeech},
    {"width_deviation_ratio", "width deviation ratio", "1", Aim::near_one, 3,
     "standard deviation over time of the width, s / o", kSpeech},
    {"aperture_speed_ratio", "aperture speed ratio, 95 %", "1", Aim::near_one, 3,
     "95th percentile over time of |aperture'|, s / o", kSpeech},
    {"lip_speed_ratio", "lip speed ratio, 95 %", "1", Aim::near_one, 3,
     "95th percentile over time of the root mean square over groups of the lips of |x'|, s / o",
     kSpeech},
    {"closure_recall", "closure recall", "1", Aim::large, 3,
     "share of rows whose least aperture over the row's frames is under 1.5 mm in s", kBilabials},
    {"closure_recall_recorded", "closure recall of the recording", "1", Aim::none, 3,
     "share of rows whose least aperture over the row's frames is under 1.5 mm in o", kBilabials},
    {"closure_kept", "closures kept", "1", Aim::large, 3,
     "share of the rows closed in o that are closed in s", "rows of /p b m/ closed in o"},
    {"contact_share", "contact", "1", Aim::large, 3,
     "share of rows whose least aperture in s lies between the 10th and the 90th percentile of the "
     "least aperture in the recordings' rows of the same phoneme",
     kLabiodentals},
    {"contact_share_recorded", "contact of the recording", "1", Aim::none, 3,
     "share of rows whose least aperture in o lies in the range of contact: 0.8 by its definition",
     kLabiodentals},
    {"contact_error", "contact error", "mm", Aim::small, 3,
     "mean over rows of the absolute difference of the least aperture, s - o", kLabiodentals},
    {"minimum_timing_error", "timing error of the minimum", "s", Aim::small, 4,
     "mean over rows of the absolute difference of the time of the least aperture", kLipRows},
    {"minimum_timing_bias", "timing bias of the minimum", "s", Aim::near_zero, 4,
     "mean over rows of the time of the least aperture in s less that in o; above 0: late",
     kLipRows},
    {"jerk_at_joins", "jerk at joins", "mm/s^3", Aim::small, 0,
     "mean over frames of the root mean square over groups of |third difference of s| rate^3, "
     "within 3 frames of a join that was not recorded",
     kThirds},
    {"jerk_inside_nodes", "jerk inside nodes", "mm/s^3", Aim::none, 0,
     "mean over frames of the root mean square over groups of |third difference of s| rate^3, "
     "farther than 3 frames from any join that was not recorded",
     kThirds},
    {"jerk_ratio", "jerk at joins / inside", "1", Aim::small, 3,
     "jerk at joins / jerk inside nodes", kThirds},
    {"jerk_recorded", "jerk of the recording", "mm/s^3", Aim::none, 0,
     "mean over frames of the root mean square over groups of |third difference of o| rate^3",
     kThirds},
    {"captured_joins", "joined as recorded", "1", Aim::none, 3,
     "share of joins whose two nodes were recorded one after the other", "joins of two nodes"},
}};

constexpr std::array<Headline, 10> kHeadlines = {{{Measure::squared_error, "E13"},
                                                  {Measure::lip_rmse, "lip RMSE"},
                                                  {Measure::lip_vertex_error, "lip vertex"},
                                                  {Measure::aperture_correlation, "r aperture"},
                                                  {Measure::width_correlation, "r width"},
                                                  {Measure::closure_recall, "closures"},
                                                  {Measure::aperture_deviation_ratio, "std apert."},
                                                  {Measure::aperture_speed_ratio, "speed ap."},
                                                  {Measure::lip_speed_ratio, "speed lips"},
                                                  {Measure::captured_joins, "captured"}}};

} // namespace

const MeasureInfo& info(Measure measure) {
  return kTable[static_cast<std::size_t>(measure)];
}

std::string_view unit_of(Measure measure, LayoutKind kind) {
  const std::string_view unit = info(measure).unit;
  if (kind == LayoutKind::markers) {
    return unit;
  }
  return unit == "mm/s" ? "1/s" : unit == "mm/s^3" ? "1/s^3" : unit == "s" ? "s" : "1";
}

std::optional<Measure> find_measure(std::string_view id) {
  const auto found = std::ranges::find(kTable, id, &MeasureInfo::id);
  if (found == kTable.end()) {
    return std::nullopt;
  }
  return static_cast<Measure>(found - kTable.begin());
}

std::array<Measure, kMeasureCount> all_measures() {
  std::array<Measure, kMeasureCount> measures = {};
  for (std::size_t i = 0; i < kMeasureCount; ++i) {
    measures[i] = static_cast<Measure>(i);
  }
  return measures;
}

std::span<const Headline> headlines() {
  return kHeadlines;
}

std::optional<double> badness(Measure measure, double value) {
  switch (info(measure).aim) {
  case Aim::small:
    return value;
  case Aim::large:
    return -value;
  case Aim::near_one:
    return std::abs(value - 1.0);
  case Aim::near_zero:
    return std::abs(value);
  case Aim::none:
    break;
  }
  return std::nullopt;
}

} // namespace phonomime
