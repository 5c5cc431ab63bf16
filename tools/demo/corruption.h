// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/demo/rest_pose.h"
#include "tools/demo/segments.h"

namespace phonomime::demo {

// What goes wrong in optical capture.
enum class Fault {
  dropout, // a marker is missing
  swap,    // two markers bear each other's names
  jump,    // a marker is 5 to 15 mm off
  freeze,  // neighbouring markers stand still in the room
  drift    // a marker slides away by 6 to 10 mm and snaps back
};
std::string_view fault_name(Fault fault);

// One fault of one sentence: frames with start_s <= k / rate < end_s.
struct PlantedFault {
  Fault fault = Fault::dropout;
  std::vector<int> markers; // indices into marker_vertices(); never `rigid` ones
  double start_s = 0.0;
  double end_s = 0.0;
  Eigen::RowVector3d offset_mm = Eigen::RowVector3d::Zero(); // jump, and drift at its end
};

// Faults for a whole corpus: about one sentence in 14 has drop-outs (two thirds of at most 100 ms,
// the rest of 250 to 500 ms), another one in 18 a contaminated vowel, the kinds in turn.
// `sentences`: #sentences; result: #sentences, most of them empty. `rest`: #markers by 3, mm.
std::vector<std::vector<PlantedFault>> plan_faults(std::span<const std::vector<Segment>> sentences,
                                                   const MarkerPose& rest, std::uint64_t seed);

// Does a fault to measured frames; a missing marker's coordinates become NaN.
void plant(const PlantedFault& fault, double rate_hz, std::vector<MarkerPose>& frames);

} // namespace phonomime::demo
