// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/retarget/keyshapes/rig.h"
#include "tools/app/motion_file.h"
#include "tools/app/weight_choices.h"

#include <filesystem>
#include <string>

namespace phonomime {

// A rig, and in which expression it moves.
struct RigChoice {
  std::filesystem::path rig;
  std::filesystem::path emotions; // emotion track; may be empty
  std::string emotion; // where the track is silent; empty: neutral, or else the rig's first
};

// A rig and its keyshapes in the source.
struct RigInUse {
  std::filesystem::path folder; // that its paths start from
  Rig rig;
  FrameMatrixD keyshapes; // #rows of the source file by #channels, offsets from the reference pose
};

// Throws InputError, also for a channel group of the layout that the keyshapes' file does not have
// and for missing values; and IoError.
RigInUse read_rig(const std::filesystem::path& path, const MotionTable& table);

// Weights of all keyshapes (rig_weights), blended by the emotion track: #frames by #keyshapes.
// Weights are non-negative unless `weights` bounds them. Throws UsageError, InputError, IoError.
FrameMatrixD decompose_by_rig(const RigInUse& rig, const RigChoice& choice,
                              const WeightChoices& weights, const MotionTable& table,
                              const MotionFile& motion);

} // namespace phonomime
