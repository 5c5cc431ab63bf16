// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

namespace phonomime {

// Puts `more` (any number by the same columns) behind the rows of `frames`.
inline void append_frames(FrameMatrixD& frames, const Eigen::Ref<const FrameMatrixD>& more) {
  frames.conservativeResize(frames.rows() + more.rows(), Eigen::NoChange);
  frames.bottomRows(more.rows()) = more;
}

// Takes the first `count` rows off `frames`.
inline void drop_frames(FrameMatrixD& frames, Eigen::Index count) {
  if (count > 0) {
    frames = FrameMatrixD(frames.bottomRows(frames.rows() - count));
  }
}

} // namespace phonomime
