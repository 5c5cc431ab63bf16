// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/curation/displaced_groups.h"
#include "db/curation/phoneme_clusters.h"
#include "db/curation/still_runs.h"
#include "db/types/layout.h"
#include "db/types/suspect_mark.h"

#include <string>
#include <vector>

namespace phonomime {

// Puts a mark among a node's, one for each reason: the one of the greatest score tells, the groups
// of all are named.
void add_mark(std::vector<SuspectMark>& marks, SuspectMark mark);

// Where the frames of a run lie, and what else there is to say of it.
struct RunPlace {
  double rate_hz = 0.0;
  double start_s = 0.0;          // of frame 0 on the sentence's clock
  std::int32_t first_frame = -1; // of the stored sentence, where the run's own frames are others
  std::int32_t frame_count = 0;
  std::size_t others = 0; // groups of the node with the same fault
};

SuspectMark frozen_mark(const StillRun& run, SuspectOrigin origin, const Layout& layout,
                        const RunPlace& place);

// What a mark says to people, with the numbers: "jump: lip_l 7.2 mm away from ...".
namespace mark_text {

std::string displaced(const DisplacedRun& run, const NeighbourModel& model, const Layout& layout,
                      double rate_hz, std::size_t others);
std::string step(const ClusterVerdict& verdict, const NodeMeasures& node,
                 const std::string& phoneme, const Layout& layout, double rate_hz);
std::string pose(const PoseVerdict& verdict, const std::string& phoneme, LayoutKind kind);
std::string duration(const ClusterVerdict& verdict, const std::string& phoneme);

} // namespace mark_text

} // namespace phonomime
