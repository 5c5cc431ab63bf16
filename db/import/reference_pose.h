// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/head.h"
#include "db/types/motion.h"

namespace phonomime {

// The frame that is nearest to the median of all, head motion apart: heads are taken off by a
// provisional reference, each channel's median is found, and the frame nearest to it (Euclidean,
// the first of equally near ones) is the next reference, until that frame stays the same. `frames`
// is #frames by #channels in mm, at least one, complete. Returns its row.
Eigen::Index frame_nearest_to_median(const FrameMatrix& frames, const HeadAnchor& anchor,
                                     Scale scale);

} // namespace phonomime
