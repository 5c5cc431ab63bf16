// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/emotion_style.h"

#include <array>

namespace phonomime::demo {

std::span<const EmotionStyle> emotion_styles() {
  static constexpr std::array<EmotionStyle, 4> styles = {
      {{.emotion = "neutral", .expression = {}, .gain = {}},
       {.emotion = "happiness",
        .expression = {.corner_out = 5.0,
                       .corner_up = 7.5,
                       .corner_back = 3.0,
                       .cheek_raise = 4.5,
                       .brow_inner_raise = 1.0,
                       .brow_outer_raise = 1.5,
                       .lower_lid_raise = 1.8,
                       .nostril_flare = 0.6,
                       .upper_lip_raise = 0.2,
                       .parting = 1.0},
        .gain = {.opening = 1.15, .spreading = 1.1, .rounding = 0.8},
        .head_pitch_deg = -2.0,
        .head_roll_deg = 2.5,
        .head_motion = 1.3,
        .blinks_per_minute = 18.0},
       {.emotion = "anger",
        .expression = {.corner_out = -1.0,
                       .corner_up = -2.0,
                       .brow_inner_raise = -6.5,
                       .brow_outer_raise = 0.5,
                       .brow_furrow = 4.0,
                       .upper_lid_drop = 0.3,
                       .lower_lid_raise = 1.2,
                       .nostril_flare = 1.5,
                       .upper_lip_raise = 1.0,
                       .lip_press = 1.6,
                       .chin_raise = 1.0},
        .gain = {.opening = 1.2, .spreading = 1.15, .rounding = 1.0},
        .head_pitch_deg = 4.0,
        .head_motion = 1.4,
        .blinks_per_minute = 9.0},
       {.emotion = "sadness",
        .expression = {.corner_out = -0.5,
                       .corner_up = -4.5,
                       .cheek_raise = -0.8,
                       .brow_inner_raise = 6.5,
                       .brow_outer_raise = -3.0,
                       .brow_furrow = 2.0,
                       .upper_lid_drop = 1.8,
                       .chin_raise = 1.8},
        .gain = {.opening = 0.75, .spreading = 0.7, .rounding = 0.9},
        .head_pitch_deg = 7.0,
        .head_roll_deg = -3.0,
        .head_motion = 0.6,
        .blinks_per_minute = 12.0}}};
  return styles;
}

} // namespace phonomime::demo
