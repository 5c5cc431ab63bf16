// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/keyshapes/select_keyshapes.h"

#include <string>
#include <vector>

namespace phonomime {

// Error of T Eq. 3.2 with some number of keyshapes.
struct KeyshapeError {
  int count = 0;
  double mean_square = 0.0; // over frames and channel groups: squared distance, in mm^2 or weight^2
};

// One line of T figure 3.6.
struct ErrorCurve {
  std::string name;
  std::vector<KeyshapeError> errors; // count ascending
};

// What errors are measured of.
struct KeyshapeMeasure {
  FrameMatrixD offsets; // #frames by #channels (part_offsets or part_offset_coordinates)
  int groups = 1;       // channel groups of the part, which the error is a mean over
  int every = 1;        // each so-manieth frame is measured

  FrameMatrixD measured() const; // those frames
};

// The mean squared error of non-negative weights (T Eq. 3.2) of these keyshapes (rows of the
// offsets) for each of the measured frames.
double reconstruction_error(const KeyshapeMeasure& measure,
                            const std::vector<Eigen::Index>& keyshapes);

// The same of no keyshapes at all: the mean square of the offsets themselves.
double motion_square(const KeyshapeMeasure& measure);

// T figure 3.6: the error as the number grows to `options.count`, for extrema, clusters in 2 and 3
// dimensions, and the hull (one number of keyshapes). `points`: #frames by #axes, the frames of
// `measure`. Clusters are looked for in at most 20,000 frames spread over all. At most `steps`
// numbers a curve.
std::vector<ErrorCurve> error_curves(const FrameMatrixD& points, const KeyshapeMeasure& measure,
                                     const KeyshapeOptions& options, int steps);

// The curves as an SVG picture, and as a table between tabs (method, count, mean_square).
std::string error_plot_svg(const std::vector<ErrorCurve>& curves, const std::string& unit);
std::string error_table_tsv(const std::vector<ErrorCurve>& curves);

} // namespace phonomime
