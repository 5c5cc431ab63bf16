// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/head_motion.h"

#include <numbers>

#include <Eigen/Geometry>

#include "tools/demo/articulation.h"

namespace phonomime::demo {

namespace {

constexpr double kLongVowel_s = 0.1;
constexpr double kNodReach_s = 0.15;
constexpr double kNod_deg = 1.6;
const Eigen::Vector3d kNeck(0.0, -60.0, -70.0);

double nod_at(double time_s, std::span<const Segment> segments) {
  double nod_deg = 0.0;
  for (const Segment& segment : segments) {
    if (!articulation_of(segment.phoneme).vowel || segment.end_s - segment.start_s < kLongVowel_s)
      continue;
    const double middle_s = 0.5 * (segment.start_s + segment.end_s);
    nod_deg += kNod_deg * ramp(time_s, middle_s - kNodReach_s, middle_s) *
               (1.0 - ramp(time_s, middle_s, middle_s + kNodReach_s));
  }
  return nod_deg;
}

} // namespace

std::vector<HeadMove> move_head(std::span<const Segment> segments, int frames, double rate_hz,
                                const EmotionStyle& style, Random& random) {
  constexpr double kLow_hz = 0.15;
  constexpr double kHigh_hz = 0.7;
  const SmoothNoise pitch(random, kLow_hz, kHigh_hz);
  const SmoothNoise yaw(random, kLow_hz, kHigh_hz);
  const SmoothNoise roll(random, kLow_hz, kHigh_hz);
  const SmoothNoise sway[3] = {
      {random, kLow_hz, kHigh_hz}, {random, kLow_hz, kHigh_hz}, {random, kLow_hz, kHigh_hz}};
  const Eigen::Vector3d seat(2.0 * random.normal(), 1.5 * random.normal(), 3.0 * random.normal());
  const double turn_deg = 1.5 * random.normal();

  std::vector<HeadMove> moves(static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) {
    const double t = k / rate_hz;
    const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180.0; };
    const double m = style.head_motion;
    const double pitch_deg = style.head_pitch_deg + m * (1.2 * pitch.at(t) + nod_at(t, segments));
    const double yaw_deg = turn_deg + m * 1.8 * yaw.at(t);
    const double roll_deg = style.head_roll_deg + m * 0.9 * roll.at(t);
    HeadMove& move = moves[static_cast<std::size_t>(k)];
    move.rotation = (Eigen::AngleAxisd(radians(roll_deg), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(radians(yaw_deg), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(radians(pitch_deg), Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    const Eigen::Vector3d shift =
        m * Eigen::Vector3d(1.5 * sway[0].at(t), 1.0 * sway[1].at(t), 1.5 * sway[2].at(t));
    move.translation_mm = kNeck - move.rotation * kNeck + seat + shift;
  }
  return moves;
}

} // namespace phonomime::demo
