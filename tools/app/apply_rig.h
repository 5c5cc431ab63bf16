// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/retarget/keyshapes/rig_consistency.h"
#include "tools/app/rig_weights.h"

#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

struct ApplyRigOptions {
  std::filesystem::path motion;   // .csv or .c3d, as read_motion_file
  std::filesystem::path database; // whose layout and reference pose it is
  std::string speaker;            // may be empty where there is only one
  std::filesystem::path layout;   // of the motion, where it is not the database's
  RigChoice choice;
  std::vector<std::filesystem::path> outputs;
  WeightChoices weights;
  double filter_s = 0.0; // filter_weights, 0 to 1
  double fps = 0.0;      // 0: the database's
};

struct ApplyRigReport {
  std::string target;
  long frames = 0;
  double rate_hz = 0.0;
  std::size_t keyshapes = 0, used = 0; // with a weight other than 0 in some frame
  std::vector<RigConflict> conflicts;
  std::vector<std::string> notes;
  std::vector<std::filesystem::path> written;
};

// Decomposes a motion into a rig's source keyshapes and moves its target by their weights
// (RigTargetFiles). Writes all outputs or none. Throws UsageError, InputError, IoError and
// Interrupted.
ApplyRigReport apply_rig(const ApplyRigOptions& options, const Progress& progress);

} // namespace phonomime
