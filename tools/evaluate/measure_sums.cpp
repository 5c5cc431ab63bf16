// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/measure_sums.h"

#include "db/types/errors.h"
#include "db/types/percentile.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace phonomime {

namespace {

// A curve that is constant but for the rounding of its mean does not vary.
bool varies(double centred_sq, double mean, std::int64_t count) {
  constexpr double kRounding = 1e-12;
  return count > 1 && centred_sq > kRounding * kRounding * static_cast<double>(count) * mean * mean;
}

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

std::optional<double> root(const std::optional<double>& value) {
  return value ? std::optional(std::sqrt(*value)) : std::nullopt;
}

std::optional<double> ratio(const std::optional<double>& numerator,
                            const std::optional<double>& denominator) {
  return numerator && denominator && *denominator > 0.0 ? std::optional(*numerator / *denominator)
                                                        : std::nullopt;
}

} // namespace

void PairMoments::add(double recorded, double synthesised) {
  ++count;
  const double share = 1.0 / static_cast<double>(count);
  const double off_recorded = recorded - mean_recorded;
  const double off_synthesised = synthesised - mean_synthesised;
  mean_recorded += off_recorded * share;
  mean_synthesised += off_synthesised * share;
  recorded_sq += off_recorded * (recorded - mean_recorded);
  synthesised_sq += off_synthesised * (synthesised - mean_synthesised);
  product += off_recorded * (synthesised - mean_synthesised);
}

void PairMoments::add(const PairMoments& other) {
  if (other.count == 0) {
    return;
  }
  const double ours = static_cast<double>(count);
  const double theirs = static_cast<double>(other.count);
  const double all = ours + theirs;
  const double off_recorded = other.mean_recorded - mean_recorded;
  const double off_synthesised = other.mean_synthesised - mean_synthesised;
  const double between = ours * theirs / all;
  recorded_sq += other.recorded_sq + between * off_recorded * off_recorded;
  synthesised_sq += other.synthesised_sq + between * off_synthesised * off_synthesised;
  product += other.product + between * off_recorded * off_synthesised;
  mean_recorded += off_recorded * theirs / all;
  mean_synthesised += off_synthesised * theirs / all;
  count += other.count;
}

std::optional<double> PairMoments::correlation() const {
  if (!varies(recorded_sq, mean_recorded, count) ||
      !varies(synthesised_sq, mean_synthesised, count)) {
    return std::nullopt;
  }
  return product / std::sqrt(recorded_sq * synthesised_sq);
}

std::optional<double> PairMoments::deviation_ratio() const {
  if (!varies(recorded_sq, mean_recorded, count)) {
    return std::nullopt;
  }
  return std::sqrt(synthesised_sq / recorded_sq);
}

std::optional<double> PairMoments::recorded_mean_error() const {
  if (count < 2) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(count);
  return std::sqrt(recorded_sq / (n - 1.0) / n);
}

void MeasureSums::add(const MeasureSums& other) {
  if (group_error_sq.empty()) {
    group_error_sq.assign(other.group_error_sq.size(), 0.0);
  } else if (!other.group_error_sq.empty() &&
             group_error_sq.size() != other.group_error_sq.size()) {
    throw InternalError({.what = "measures of two layouts do not add up",
                         .expected = std::to_string(group_error_sq.size()) + " groups",
                         .got = std::to_string(other.group_error_sq.size())});
  }
  for (std::size_t g = 0; g < other.group_error_sq.size(); ++g) {
    group_error_sq[g] += other.group_error_sq[g];
  }
  sentences += other.sentences;
  frames += other.frames;
  for (std::size_t c = 0; c < kLipCurves; ++c) {
    curves[c].add(other.curves[c]);
    warped_curves[c].add(other.warped_curves[c]);
  }
  append(aperture_speed_recorded, other.aperture_speed_recorded);
  append(aperture_speed_synthesised, other.aperture_speed_synthesised);
  append(lip_speed_recorded, other.lip_speed_recorded);
  append(lip_speed_synthesised, other.lip_speed_synthesised);
  for (Tally MeasureSums::*const tally :
       {&MeasureSums::lip_error_sq, &MeasureSums::largest_lip_error_sq,
        &MeasureSums::upper_face_dynamics, &MeasureSums::upper_face_dynamics_absolute,
        &MeasureSums::velocity_error, &MeasureSums::lip_velocity_error, &MeasureSums::closed,
        &MeasureSums::closed_recorded, &MeasureSums::closed_kept, &MeasureSums::contact,
        &MeasureSums::contact_recorded, &MeasureSums::contact_error, &MeasureSums::minimum_timing,
        &MeasureSums::minimum_timing_absolute, &MeasureSums::jerk_at_joins,
        &MeasureSums::jerk_inside, &MeasureSums::jerk_recorded, &MeasureSums::captured}) {
    (this->*tally).add(other.*tally);
  }
}

MeasureValues measure_values(const MeasureSums& sums) {
  using enum Measure;
  MeasureValues values;
  const Tally error_sq = {
      std::accumulate(sums.group_error_sq.begin(), sums.group_error_sq.end(), 0.0),
      sums.frames * static_cast<std::int64_t>(sums.group_error_sq.size())};
  values[squared_error] = error_sq.mean();
  values[rmse] = root(error_sq.mean());
  values[lip_rmse] = root(sums.lip_error_sq.mean());
  values[lip_vertex_error] = sums.largest_lip_error_sq.mean();
  values[lip_vertex_error_root] = root(sums.largest_lip_error_sq.mean());
  values[upper_face_dynamics] = sums.upper_face_dynamics.mean();
  values[upper_face_dynamics_absolute] = sums.upper_face_dynamics_absolute.mean();
  values[velocity_error] = sums.velocity_error.mean();
  values[lip_velocity_error] = sums.lip_velocity_error.mean();
  const auto curve = [](LipCurve which) { return static_cast<std::size_t>(which); };
  const PairMoments& aperture = sums.curves[curve(LipCurve::aperture)];
  const PairMoments& width = sums.curves[curve(LipCurve::width)];
  values[aperture_correlation] = aperture.correlation();
  values[width_correlation] = width.correlation();
  values[protrusion_correlation] = sums.curves[curve(LipCurve::protrusion)].correlation();
  values[aperture_correlation_warped] = sums.warped_curves[curve(LipCurve::aperture)].correlation();
  values[width_correlation_warped] = sums.warped_curves[curve(LipCurve::width)].correlation();
  values[protrusion_correlation_warped] =
      sums.warped_curves[curve(LipCurve::protrusion)].correlation();
  values[aperture_deviation_ratio] = aperture.deviation_ratio();
  values[width_deviation_ratio] = width.deviation_ratio();
  constexpr double kFast = 0.95;
  values[aperture_speed_ratio] = ratio(percentile(sums.aperture_speed_synthesised, kFast),
                                       percentile(sums.aperture_speed_recorded, kFast));
  values[lip_speed_ratio] = ratio(percentile(sums.lip_speed_synthesised, kFast),
                                  percentile(sums.lip_speed_recorded, kFast));
  values[closure_recall] = sums.closed.mean();
  values[closure_recall_recorded] = sums.closed_recorded.mean();
  values[closure_kept] = sums.closed_kept.mean();
  values[contact_share] = sums.contact.mean();
  values[contact_share_recorded] = sums.contact_recorded.mean();
  values[contact_error] = sums.contact_error.mean();
  values[minimum_timing_error] = sums.minimum_timing_absolute.mean();
  values[minimum_timing_bias] = sums.minimum_timing.mean();
  values[jerk_at_joins] = sums.jerk_at_joins.mean();
  values[jerk_inside_nodes] = sums.jerk_inside.mean();
  values[jerk_ratio] = ratio(sums.jerk_at_joins.mean(), sums.jerk_inside.mean());
  values[jerk_recorded] = sums.jerk_recorded.mean();
  values[captured_joins] = sums.captured.mean();
  return values;
}

} // namespace phonomime
