// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "tools/demo/emotion_style.h"
#include "tools/demo/random.h"
#include "tools/demo/segments.h"

namespace phonomime::demo {

// A rigid move of the head: marker in the room = rotation * marker + translation_mm.
struct HeadMove {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
};

// A few degrees and millimetres about the neck, after smooth noise, with a nod on each long vowel
// (Festival's segments carry no stress; its stressed vowels are the long ones). One per frame.
std::vector<HeadMove> move_head(std::span<const Segment> segments, int frames, double rate_hz,
                                const EmotionStyle& style, Random& random);

} // namespace phonomime::demo
