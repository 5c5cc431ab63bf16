// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

namespace phonomime {

// The motion at another rate (E section VII-B, DESIGN section 5): sample k is at k / fps, for every
// k with k / fps <= end_s (frame_count_to), so that frames never drift against the sound. Each
// sample is a windowed-sinc sum (LowPassKernel) at its own time; constants come out exactly. Beyond
// its first and last frame the motion is continued by point reflection at that frame, which keeps
// its slope, and a sample after the last frame is that frame held. At the motion's own rate frames
// are copied bit for bit.
// (libsamplerate is no fit: float samples, zeros beyond the ends, a length off by a frame.)
// Head poses go the same way, rotations by their sign-aligned quaternions, normalised again.
// Throws InternalError where the motion has no frames or no rate, fps or end_s is not finite, fps
// is not positive or end_s negative, or where head poses do not match the frames.
CoefficientMotion resample_motion(const CoefficientMotion& motion, double fps, double end_s);

} // namespace phonomime
