// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"

#include <algorithm>
#include <vector>

namespace phonomime {

// A stretch over which a group keeps one place while those around it move.
struct StillRun {
  int group = -1; // -1: all groups
  Eigen::Index first_frame = 0;
  Eigen::Index frame_count = 0;
  double others = 0.0; // how far the nearest groups that do move move meanwhile (median; mm)

  // How long it lasts, times 0.1 s; 1 at least.
  double score(double rate_hz) const {
    return std::max(1.0, static_cast<double>(frame_count) / rate_hz / 0.1);
  }
};

struct StillLimits {
  double tolerance = 0.0; // a channel keeps its value within this; mm or weight
  double least_s = 0.1;   // markers: frames times their duration
};

// Markers one by one, where the eight nearest that are not still themselves move by at least 0.3 mm
// in the median: at a pause of the whole face nothing is frozen. A marker that is still in nine of
// ten frames is at rest by nature. The whole face, or all weights (one alone may well
// rest), where nothing changes for 0.2 s and 5 frames. `frames`: #frames by #channels, mm or
// weights; a frame with a missing channel (NaN) ends the run of its group.
std::vector<StillRun> still_runs(const FrameMatrixD& frames, const Layout& layout, double rate_hz,
                                 const StillLimits& limits);

} // namespace phonomime
