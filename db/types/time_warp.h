// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

namespace phonomime {

// Warps a motion node in time to another number of frames (E section VII-B, DESIGN section 11):
// frame i of m is taken, by linear interpolation, at u = i (n - 1) / (m - 1) of the node's n
// frames, the middle where m = 1. Where u is whole the frame is copied, so that a node which keeps
// its length keeps its values bit for bit. `node`: n by #dimensions, n >= 1. `warped`: m by
// #dimensions, written.
void time_warp(const Eigen::Ref<const FrameMatrix>& node, Eigen::Ref<FrameMatrixD> warped);
void time_warp(const Eigen::Ref<const FrameMatrixD>& node, Eigen::Ref<FrameMatrixD> warped);

} // namespace phonomime
