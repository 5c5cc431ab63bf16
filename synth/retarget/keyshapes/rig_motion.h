// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "db/types/layout.h"
#include "db/types/motion.h"
#include "synth/retarget/keyshapes/rig.h"
#include "synth/retarget/weight_solver.h"

#include <string>
#include <vector>

namespace phonomime {

// Every keyshape of a rig, set after set: "set expression/part/name" in the order of the columns of
// rig_weights.
std::vector<std::string> keyshape_names(const Rig& rig);

// The expressions of a rig's sets, each once, in their order.
std::vector<std::string> rig_expressions(const Rig& rig);

// The alphas of T5.1 from an emotion track: #frames by #expressions. Each emotion of a span gets
// its intensity, the expression "neutral" what is left of 1; `fallback` fills time without a span;
// one glides into the next (filter_weights of `glide_s`). Of a single expression all are 1. Throws
// InputError for an emotion that the rig has no set of, with those that it has.
FrameMatrixD expression_shares(const Rig& rig, const EmotionTrack& track,
                               const EmotionMixture& fallback, double rate_hz, Eigen::Index frames,
                               double glide_s = 0.05);

// Weights of all keyshapes for each frame: each set is solved apart on the channels of its part
// (T Eq. 3.2, WeightSolver) and multiplied by its expression's share (T5.1): #frames by #keyshapes.
//
// `source`: #rows of the rig's source file by #channels, `frames`: #frames by #channels (NaN =
// missing), both offsets from the reference pose. `shares`: #frames by #expressions. Throws
// InputError where a keyshape names a row that the source has not.
FrameMatrixD rig_weights(const Rig& rig, const Layout& layout, const FrameMatrixD& source,
                         const FrameMatrixD& frames, const FrameMatrixD& shares,
                         const WeightOptions& options);

// What the keyshapes do to the target, as numbers that are 0 at rest and add up.
struct RigTargets {
  std::vector<std::string> names; // of the values
  Eigen::MatrixXd values;         // #keyshapes by #values

  // What weights (#frames by #keyshapes) come to: #frames by #values.
  FrameMatrixD motion(const FrameMatrixD& weights) const { return weights * values; }
};

// Of a target `shapes`: its shapes' weights, in order of name.
RigTargets shape_targets(const Rig& rig);

} // namespace phonomime
