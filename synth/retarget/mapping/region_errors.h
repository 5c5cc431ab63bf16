// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"
#include "synth/retarget/mapping/marker_shapes.h"

#include <vector>

namespace phonomime {

// How far the vertices under a region's markers are from where the motion would have them.
struct RegionError {
  Region region = Region::lips;
  int markers = 0;     // of the region on the face
  double rms_mm = 0.0; // over markers and frames
};

// `channels`: #frames by #channels, mm, NaN = missing (passed over); `weights`: #frames by #shapes.
// Both movements are taken from their own rest. Regions without a marker on the face are left out.
std::vector<RegionError> region_errors(const MarkerShapes& shapes, const Layout& layout,
                                       const FrameMatrixD& channels, const FrameMatrixD& weights);

} // namespace phonomime
