// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <cstdint>
#include <vector>

namespace phonomime {

// Where recorded frames lie on the sentence's clock: frame j is at start_s + j / rate_hz.
struct SourceClock {
  double rate_hz = 0.0;
  double start_s = 0.0;
};

// `frames` (#recorded by #channels, finite) at the times k / rate_hz, k = 0 .. count - 1: count by
// #channels. Upwards by the monotone cubic of Fritsch and Butland, channel by channel: at a
// recorded time it is the recorded frame, and between two it stays within them, so that lips which
// touch do not run through each other. (On 25 Hz recordings a C2 spline takes the lips up to 2 mm
// beyond the recorded frames, and misses left-out frames by only 4 % less.) Downwards by a
// Kaiser-windowed sinc that passes 0.9 of the new Nyquist frequency. Before the first and after the
// last recorded frame these are held.
FrameMatrixD resample(const FrameMatrixD& frames, const SourceClock& recorded, double rate_hz,
                      Eigen::Index count);

// Poses likewise: quaternions (neighbours on the same side) as four channels, then made unit.
std::vector<HeadPose> resample_head(const std::vector<HeadPose>& head, const SourceClock& recorded,
                                    double rate_hz, Eigen::Index count);

// 1 where a frame draws on a marked recorded frame: one of its two neighbours upwards, one within a
// new frame's duration downwards.
std::vector<std::uint8_t> resample_marks(const std::vector<std::uint8_t>& marks,
                                         const SourceClock& recorded, double rate_hz,
                                         Eigen::Index count);

} // namespace phonomime
