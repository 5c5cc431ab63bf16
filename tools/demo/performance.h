// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/demo/face_fields.h"
#include "tools/demo/head_motion.h"

namespace phonomime::demo {

inline constexpr double kRate_hz = 120.0;
inline constexpr double kNoise_mm = 0.07; // standard deviation of each coordinate's measurement

// One spoken sentence, before and after the head's moves and the measurement. Per frame.
struct Performance {
  std::vector<MarkerPose> face; // free of head motion and noise
  std::vector<HeadMove> head;
  std::vector<MarkerPose> measured; // head * face + noise
};

// `segments`: the whole sentence from time 0. The same arguments give the same numbers.
Performance perform(std::span<const Segment> segments, const EmotionStyle& style,
                    const FaceFields& fields, std::uint64_t seed);

} // namespace phonomime::demo
