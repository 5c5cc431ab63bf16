// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <cstdint>
#include <vector>

namespace phonomime {

enum class GapAction {
  filled, // short enough, inside the recording: cubic interpolation
  held,   // short enough, at an end of the recording: the nearest value
  marked  // too long: bridged by a line (held at the ends), its frames marked
};

// A run of frames in which one group is missing.
struct Gap {
  int group = 0; // channels group * channels_per_group and on
  Eigen::Index first_frame = 0;
  Eigen::Index frame_count = 0;
  GapAction action = GapAction::filled;
  bool operator==(const Gap&) const = default;
};

struct GapFill {
  FrameMatrixD frames;                     // finite everywhere
  std::vector<std::uint8_t> frame_has_gap; // #frames; 1 = in a marked gap
  std::vector<Gap> gaps;                   // in order of (group, first_frame)
};

// The groups that no frame has, in order.
std::vector<int> groups_missing_throughout(const FrameMatrixD& frames, int channels_per_group);

// Fills every gap of `frames` (#frames by #groups * channels_per_group, any unit). A group is
// missing in a frame where one of its channels is not finite. A gap is as long as its frames at
// `rate_hz`; up to `limit_s` it is filled by the polynomial through the two frames on either side
// of it that are present (one where the next but one is missing too: then of lower degree). No
// group may be missing throughout.
GapFill fill_gaps(const FrameMatrixD& frames, int channels_per_group, double rate_hz,
                  double limit_s);

} // namespace phonomime
