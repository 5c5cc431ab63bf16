// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/performance.h"

#include <algorithm>

namespace phonomime::demo {

namespace {

// Times at which the lids meet, from the first blink to the end.
std::vector<double> plan_blinks(double end_s, double per_minute, Random& random) {
  const double mean_s = 60.0 / per_minute;
  std::vector<double> times;
  for (double t = random.uniform(0.1, mean_s); t < end_s; t += random.uniform(0.6, 1.4) * mean_s)
    times.push_back(t);
  return times;
}

double blink_at(double time_s, std::span<const double> blinks) {
  constexpr double kShutting_s = 0.08;
  constexpr double kShut_s = 0.02;
  constexpr double kOpening_s = 0.16;
  double shut = 0.0;
  for (const double t : blinks)
    shut = std::max(shut, ramp(time_s, t - kShutting_s, t) *
                              (1.0 - ramp(time_s, t + kShut_s, t + kShut_s + kOpening_s)));
  return shut;
}

} // namespace

Performance perform(std::span<const Segment> segments, const EmotionStyle& style,
                    const FaceFields& fields, std::uint64_t seed) {
  Random random(seed);
  const std::vector<ArticulatoryFrame> speech = articulate(segments, kRate_hz, style.gain);
  const int frames = static_cast<int>(speech.size());
  const SmoothNoise intensity(random, 0.2, 0.6);
  const std::vector<double> blinks =
      plan_blinks(segments.back().end_s, style.blinks_per_minute, random);

  Performance performance;
  performance.head = move_head(segments, frames, kRate_hz, style, random);
  for (int k = 0; k < frames; ++k) {
    const double t = k / kRate_hz;
    const FaceState state = {.speech = speech[static_cast<std::size_t>(k)],
                             .expression = style.expression,
                             .intensity = 1.0 + 0.12 * intensity.at(t),
                             .blink = blink_at(t, blinks)};
    const MarkerPose face = fields.pose(state);
    const HeadMove& head = performance.head[static_cast<std::size_t>(k)];
    MarkerPose measured = face * head.rotation.transpose();
    measured.rowwise() += head.translation_mm.transpose();
    for (Eigen::Index i = 0; i < measured.size(); ++i)
      measured.data()[i] += kNoise_mm * random.normal();
    performance.face.push_back(face);
    performance.measured.push_back(measured);
  }
  return performance;
}

} // namespace phonomime::demo
