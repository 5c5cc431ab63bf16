// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/curation/neighbour_model.h"
#include "db/types/layout.h"
#include "db/types/motion.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace phonomime {

// A stretch of a sentence over which a group is not where its neighbours put it.
struct DisplacedRun {
  std::string_view reason; // suspect::kSwapped, kJump, kDrift or kNeighbours
  int group = 0;
  int partner = -1; // with which a swapped group has changed places
  Eigen::Index first_frame = 0;
  Eigen::Index frame_count = 0;
  std::vector<double> size; // #frames of the run: length of the displacement, mm or weight
  double peak = 0.0;        // largest of these
  double change_s = 0.0;    // of a jump or a drift: how long it takes from a fifth of the peak to
                            // four fifths (or back, whichever tells it)
};

// The runs of one sentence, in order of (first_frame, group). At each frame the group that is
// farthest from its predicted place is taken to be displaced, and its displacement is taken off
// the residuals of all that it has led astray, until the rest is within the limits: so the fault
// stays with the marker that has it. Two displaced groups are swapped where each is near the
// other's predicted place. A displacement that comes and goes at once is a jump, one that comes or
// goes slowly a drift. `frame_has_gap`: #frames; those are passed over.
std::vector<DisplacedRun> displaced_runs(const NeighbourModel& model, const FrameMatrix& frames,
                                         const std::vector<std::uint8_t>& frame_has_gap,
                                         const Layout& layout, double rate_hz);

} // namespace phonomime
