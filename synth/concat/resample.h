// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/low_pass.h"
#include "db/types/motion.h"

namespace phonomime {

// Passes as much of the joins' speed as the output's rate can hold.
inline constexpr LowPassShape kOutputLowPass{
    .cutoff = 1.0, .half_width_frames = 6.0, .kaiser_beta = 5.0};

// The motion at another rate (E section VII-B, DESIGN section 5): sample k is at k / fps, for every
// k with k / fps <= end_s (frame_count_to), so that frames never drift against the sound. Each
// sample is a windowed-sinc sum (low_pass) at its own time; constants come out exactly, and a
// sample after the last frame is that frame held. At the motion's own rate frames are copied bit
// for bit. Head poses go the same way, rotations by their sign-aligned quaternions, normalised
// again. Throws InternalError where the motion has no frames or no rate, fps or end_s is not
// finite, fps is not positive or end_s negative, or where head poses do not match the frames.
CoefficientMotion resample_motion(const CoefficientMotion& motion, double fps, double end_s);

} // namespace phonomime
