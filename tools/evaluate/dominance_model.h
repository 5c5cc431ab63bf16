// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "tools/evaluate/anchors.h"

#include <vector>

namespace phonomime {

// Coarticulation by dominance functions (Cohen and Massaro, "Modeling coarticulation in synthetic
// visual speech", 1993): around its anchor c each segment s pulls a control parameter towards its
// target with
//   D_s(t) = height_s exp(-rate_s |t - c_s|),
// rate_s of its own before and after the anchor, and the parameter is sum D_s target_s / sum D_s.
// The control parameters are the PCA coefficients, each with heights, rates and targets of its own
// for every viseme.
struct DominanceModel {
  FrameMatrixD target;      // #visemes by #dimensions
  FrameMatrixD log_height;  // the same, as are the others
  FrameMatrixD log_rate[2]; // of 1/s; [0] before the anchor, [1] after it
  std::vector<bool> known;  // #visemes; others have no segments
  double rate_hz = 0.0;

  // #frames by #dimensions from the anchors of a transcript.
  FrameMatrixD evaluate(const std::vector<Anchor>& anchors, Eigen::Index frame_count) const;
};

// The model with the least squared error on frames within the speech of `sentences` (at most
// kDominanceFrames of them, evenly spread), by Levenberg-Marquardt from heights of 1 and rates of
// kFirstDominanceRate_hz; targets are eliminated (variable projection: given heights and rates they
// are a linear least-squares problem). A weak ridge draws targets towards the visemes' mean poses
// and heights and rates towards their start. The same for any number of threads. Throws
// Interrupted.
DominanceModel fit_dominance(const MotionTable& table,
                             const std::vector<TrainingSentence>& sentences, int threads,
                             const Progress& progress);
inline constexpr Eigen::Index kDominanceFrames = 6000;
inline constexpr double kFirstDominanceRate_hz = 12.0;

} // namespace phonomime
