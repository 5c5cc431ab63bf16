// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"
#include "db/types/stored_sentence.h"

#include <cstdint>
#include <string>

namespace phonomime::test {

inline constexpr double kFaceRate_hz = 100.0;
inline constexpr int kFaceMarkers = 25;

// 5 by 5 markers 10 mm apart in a plane, called "m0" and on, row by row.
Layout made_face();

// Motion of that face: six slow movements of the whole skin, a few mm each, and noise of `noise_mm`
// a coordinate. #frames by #channels.
FrameMatrix made_motion(Eigen::Index frames, std::uint64_t seed, double noise_mm = 0.05);

// A sentence of such motion with nodes of 10 frames from frame 10 on, the last 10 are silence; the
// phonemes "aa", "b", "k" in turn.
StoredSentence made_sentence(const std::string& name, Eigen::Index frames, std::uint64_t seed);

// Marker of a frame, to read and to write.
inline auto marker(FrameMatrix& frames, Eigen::Index frame, int group) {
  return frames.row(frame).segment<3>(3 * group);
}

} // namespace phonomime::test
