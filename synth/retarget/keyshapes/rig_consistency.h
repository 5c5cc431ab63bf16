// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "synth/retarget/keyshapes/rig.h"
#include "synth/retarget/keyshapes/rig_motion.h"

#include <string>
#include <vector>

namespace phonomime {

// Two changes that are alike in the source and contrary in the target (T section 3.2 leaves finding
// them open). Keyshapes are named as in the rig, the pose at rest "rest".
struct RigConflict {
  std::string expression, part;
  std::string from, to;             // one change
  std::string other_from, other_to; // the other
  double source_likeness = 0.0;     // cosine of the two changes of the source's channels
  double target_likeness = 0.0;     // the same of the target's values: negative
  std::string value;                // of the target, that is most at odds
};

// One line for people: the two changes, how alike and how contrary they are, and the value.
std::string conflict_words(const RigConflict& conflict);

// All pairs of changes between two poses of a set (its keyshapes and the pose at rest) whose source
// cosine is at least 0.9 and whose target cosine is under -0.25, the most contrary first, `most` of
// them. Changes under a tenth of the set's largest, in source or target, are passed over.
// `source`: #rows by #channels, offsets from the reference pose.
std::vector<RigConflict> find_conflicts(const Rig& rig, const Layout& layout,
                                        const FrameMatrixD& source, const RigTargets& targets,
                                        std::size_t most = 20);

} // namespace phonomime
