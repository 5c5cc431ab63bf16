// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "tools/demo/rest_pose.h"

namespace phonomime::demo {

enum class C3dNumbers { scaled_integers, floats };

// Size of a step of scaled integers: +-327 mm in 16 bits.
inline constexpr float kC3dStep_mm = 0.01f;

// A C3D file (little-endian, Intel): header, parameters (POINT: USED, SCALE, RATE, DATA_START,
// FRAMES, UNITS mm, LABELS; ANALOG: USED 0), and 3D points, first frame 1. `frames`: #frames of
// #markers by 3, mm; NaN is written as residual -1. Throws InternalError where a coordinate does
// not fit 16 bits, or where there are no frames or more than 32767.
std::string format_c3d(std::span<const MarkerPose> frames, double rate_hz, C3dNumbers numbers);

} // namespace phonomime::demo
