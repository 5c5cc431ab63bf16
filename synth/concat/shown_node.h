// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/frame_times.h"
#include "db/types/motion_table.h"

#include <cstdint>

namespace phonomime {

// A step whose node is seen, with the frames it has.
struct ShownNode {
  NodeIndex node = kNoNode;
  FrameRange frames;     // of the motion, at least one
  bool captured = false; // as recorded after the node before it
};

// Smooths the join of two nodes where they meet and were not recorded so (E16): up to
// `half_window` frames of either, with the visibility weights of their phonemes. `frames`: #frames
// by #dimensions of the motion from its frame `first` on.
void smooth_join(FrameMatrixD& frames, std::int64_t first, const MotionTable& table,
                 const ShownNode& left, const ShownNode& right, std::int64_t half_window);

} // namespace phonomime
