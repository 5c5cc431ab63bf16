// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/gaps.h"
#include "db/import/resample.h"
#include "db/types/layout.h"
#include "db/types/motion.h"

#include <cstdint>
#include <string>
#include <vector>

namespace phonomime {

// Recorded motion as a database keeps it: head motion off, no gaps, at the database's rate.
struct NormalMotion {
  FrameMatrixD channels;                   // #frames by #channels, mm or weights; finite everywhere
  std::vector<std::uint8_t> frame_has_gap; // #frames; 1 = a channel was missing and not filled
  std::vector<HeadPose> head;              // #frames for markers, empty for weights
  std::vector<Gap> gaps;                   // in recorded frames
  Eigen::Index interpolated_poses = 0;     // recorded frames
};

struct NormaliseOptions {
  std::string where;        // of the motion, for errors
  std::string whose;        // "sentence s1", likewise
  double gap_limit_s = 0.1; // longest gap that is filled
  double rate_hz = 0.0;     // of the result
  Eigen::Index frames = 0;  // of the result
};

// Takes the head motion off, then fills gaps (so that a filled marker follows the face), then
// resamples. `recorded` is #recorded by #channels in the layout, NaN = missing, no group missing
// throughout; `reference_pose` is the speaker's (#channels), looked at for markers only. Throws
// InputError where no frame shows enough of the head's anchor.
NormalMotion normalise(const FrameMatrixD& recorded, const SourceClock& clock, const Layout& layout,
                       const Eigen::VectorXd& reference_pose, Scale scale,
                       const NormaliseOptions& options);

// Throws InputError where a group is missing in every frame (#recorded by #channels).
void check_groups(const FrameMatrixD& recorded, const Layout& layout, const std::string& where,
                  const std::string& whose, const std::string& remedy);

} // namespace phonomime
