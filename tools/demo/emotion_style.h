// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

#include "tools/demo/dominance.h"

namespace phonomime::demo {

// What a face shows beside speech, in mm unless said otherwise; all zero at rest.
struct Expression {
  double corner_out = 0.0; // corners of the mouth: away from each other
  double corner_up = 0.0;
  double corner_back = 0.0;
  double cheek_raise = 0.0;
  double brow_inner_raise = 0.0;
  double brow_outer_raise = 0.0;
  double brow_furrow = 0.0;    // inner brows towards each other
  double upper_lid_drop = 0.0; // negative: eyes wide
  double lower_lid_raise = 0.0;
  double nostril_flare = 0.0;
  double upper_lip_raise = 0.0; // both lips' upper one, a sneer
  double lip_press = 0.0;       // outer edges towards the line of the mouth
  double chin_raise = 0.0;
  double parting = 0.0; // lips apart while no contact holds them
};

// An emotion as the demo acts it.
struct EmotionStyle {
  std::string_view emotion;
  Expression expression; // at intensity 1
  ArticulationGain gain;
  double head_pitch_deg = 0.0; // nose down: positive
  double head_roll_deg = 0.0;
  double head_motion = 1.0; // factor on the head's movements
  double blinks_per_minute = 16.0;
};

// neutral, happiness, anger, sadness.
std::span<const EmotionStyle> emotion_styles();

} // namespace phonomime::demo
