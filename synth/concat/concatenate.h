// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "db/types/motion_table.h"
#include "synth/concat/blend.h"
#include "synth/concat/silence.h"

#include <span>
#include <vector>

namespace phonomime {

// One phoneme of a transcript with the motion node that the search chose for it.
struct ConcatStep {
  bool is_silence = false; // /pau/: filled from its borders unless show_node
  double start_s = 0.0;
  double end_s = 0.0;
  NodeIndex node = kNoNode; // of a phoneme always; of /pau/ only where show_node makes it matter
  bool captured = false;    // the node's pre() is the node of the step before
  bool show_node = false;   // a `use` constraint put the node on this /pau/

  bool shows() const { return !is_silence || show_node; } // else it is filled
};

struct ConcatOptions {
  SilenceOptions silence;
  int smoothing_half_window = 3; // s of E16, in frames; 0 = no smoothing
  BlendOptions blend;            // of several paths
};

// From path to motion at the database rate (E section VII-B, DESIGN sections 5 and 11), in the
// table's PCA coefficients: each node is time-warped to its phoneme's frames, each join that is not
// a captured succession is smoothed (E16, from left to right, each over what the ones before it
// left, with the visibility weights of the two nodes' phonemes), then /pau/ is filled.
//
// Frames are shared out by assign_frames: a phoneme shorter than a frame takes one from a
// neighbour, and a /pau/ too short for a frame makes its neighbours meet in an ordinary join. The
// motion has frames 0 to floor(end * rate); a frame at the very end belongs to the last step, whose
// last frame it repeats where that is a phoneme. The head rests (`head` stays empty).
//
// `steps`: in order of time from 0 on, each starting where the one before ends, none empty of a
// node that it has to show. Throws InternalError where steps, table or options break this,
// InputError where the transcript is longer than 10,000,000 frames.
CoefficientMotion concatenate(const MotionTable& table, std::span<const ConcatStep> steps,
                              const ConcatOptions& options = {});

// The same of several paths through one transcript: each is warped and smoothed, the stretches
// between the pauses are blended (blend_motions), then /pau/ is filled. The paths differ in `node`
// and `captured` alone. `expected`: one a step, the motion that is expected there, from its start
// to its end, any number of frames by #dimensions, at least one for a step that shows a node; or
// none at all. Throws InternalError where these do not fit each other.
CoefficientMotion concatenate(const MotionTable& table,
                              std::span<const std::vector<ConcatStep>> paths,
                              std::span<const FrameMatrixD> expected,
                              const ConcatOptions& options = {});

} // namespace phonomime
