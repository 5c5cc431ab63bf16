// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/dominance.h"

#include <algorithm>
#include <cmath>

#include "tools/demo/random.h"

namespace phonomime::demo {

namespace {

// The times at which a target is held, with its weight.
struct Held {
  const ArticulatoryTarget* target;
  double from_s;
  double to_s;
};

constexpr std::array<double, articulator_count> kTheta_per_s = {20.0, 28.0, 14.0, 14.0, 28.0, 28.0};

double dominance_of(const ArticulatoryTarget& target, int articulator) {
  if (articulator == jaw)
    return target.jaw_dominance;
  return articulator == width || articulator == protrusion ? target.round_dominance
                                                           : target.lip_dominance;
}

// A sound holds each of its targets for the middle third of the target's share of it. Silence holds
// for all but 60 ms beside speech.
std::vector<Held> hold_targets(std::span<const Segment> segments) {
  constexpr double kBesideSpeech_s = 0.06;
  std::vector<Held> held;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const std::vector<ArticulatoryTarget>& targets = articulation_of(segment.phoneme).targets;
    if (segment.phoneme == kSilence) {
      const double middle_s = 0.5 * (segment.start_s + segment.end_s);
      const double from_s = i == 0 ? segment.start_s : segment.start_s + kBesideSpeech_s;
      const double to_s =
          i + 1 == segments.size() ? segment.end_s : segment.end_s - kBesideSpeech_s;
      held.push_back({&targets.front(), std::min(from_s, middle_s), std::max(to_s, middle_s)});
      continue;
    }
    const double share_s = (segment.end_s - segment.start_s) / static_cast<double>(targets.size());
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const double start_s = segment.start_s + share_s * static_cast<double>(k);
      held.push_back({&targets[k], start_s + share_s / 3.0, start_s + 2.0 * share_s / 3.0});
    }
  }
  return held;
}

double with_gain(double value, int articulator, const ArticulationGain& gain) {
  if (articulator == jaw || articulator == aperture)
    return value * gain.opening;
  if (articulator == protrusion)
    return value * gain.rounding;
  if (articulator == width)
    return value * (value > 0.0 ? gain.spreading : gain.rounding);
  return value;
}

Articulators blend_at(double time_s, std::span<const Held> held, const ArticulationGain& gain) {
  Articulators sum{};
  Articulators total{};
  for (const Held& h : held) {
    const double tau_s = std::max({0.0, h.from_s - time_s, time_s - h.to_s});
    for (int a = 0; a < articulator_count; ++a) {
      const double d = dominance_of(*h.target, a) * std::exp(-kTheta_per_s[a] * tau_s);
      sum[a] += d * with_gain(h.target->value[a], a, gain);
      total[a] += d;
    }
  }
  for (int a = 0; a < articulator_count; ++a)
    sum[a] /= total[a];
  return sum;
}

// How far a contact of this kind is in force: 1 in the cores, ramps beside them.
double contact_at(double time_s, std::span<const Segment> segments, Contact kind) {
  double open = 1.0;
  for (const Segment& segment : segments) {
    if (articulation_of(segment.phoneme).contact != kind)
      continue;
    const double margin_s = kContactMargin * (segment.end_s - segment.start_s);
    const double from_s = segment.start_s + margin_s;
    const double to_s = segment.end_s - margin_s;
    open *= 1.0 - ramp(time_s, from_s - kContactRamp_s, from_s) *
                      (1.0 - ramp(time_s, to_s, to_s + kContactRamp_s));
  }
  return 1.0 - open;
}

std::vector<Articulators> smooth(const std::vector<Articulators>& blend, double rate_hz) {
  const double sigma = kBlendSigma_s * rate_hz;
  const int reach = static_cast<int>(std::ceil(4.0 * sigma));
  const int last = static_cast<int>(blend.size()) - 1;
  std::vector<Articulators> smoothed(blend.size());
  for (int k = 0; k <= last; ++k) {
    double total = 0.0;
    for (int j = -reach; j <= reach; ++j) {
      const double weight = std::exp(-0.5 * j * j / (sigma * sigma));
      total += weight;
      for (int a = 0; a < articulator_count; ++a)
        smoothed[k][a] += weight * blend[std::clamp(k + j, 0, last)][a];
    }
    for (double& value : smoothed[k])
      value /= total;
  }
  return smoothed;
}

} // namespace

int frame_count(double end_s, double rate_hz) {
  int count = static_cast<int>(end_s * rate_hz);
  while (count / rate_hz < end_s)
    ++count;
  return count;
}

std::vector<ArticulatoryFrame> articulate(std::span<const Segment> segments, double rate_hz,
                                          const ArticulationGain& gain) {
  const std::vector<Held> held = hold_targets(segments);
  const int frames = frame_count(segments.back().end_s, rate_hz);
  std::vector<Articulators> blend;
  for (int k = 0; k < frames; ++k)
    blend.push_back(blend_at(k / rate_hz, held, gain));
  blend = smooth(blend, rate_hz);

  const Articulators& bite = articulation_of("f").targets.front().value;
  std::vector<ArticulatoryFrame> motion(blend.size());
  for (int k = 0; k < frames; ++k) {
    ArticulatoryFrame& frame = motion[k];
    frame.value = blend[k];
    frame.lip_closure = contact_at(k / rate_hz, segments, Contact::lips);
    frame.lip_tuck = contact_at(k / rate_hz, segments, Contact::lip_and_teeth);
    for (const Articulator a : {aperture, upper_raise, tuck})
      frame.value[a] += frame.lip_tuck * (bite[a] - frame.value[a]);
    frame.value[aperture] *= 1.0 - frame.lip_closure;
  }
  return motion;
}

} // namespace phonomime::demo
