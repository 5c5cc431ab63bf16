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

// The mean squared error of non-negative weights (T Eq. 3.2) of the keyshapes for each of `frames`.
// `offsets`: #frames by #channels, from the reference pose; `keyshapes`: rows of it.
double reconstruction_error(const FrameMatrixD& offsets, const std::vector<Eigen::Index>& keyshapes,
                            int channels_per_group);

// T figure 3.6: the error as the number grows to `options.count`, for extrema, clusters in 2 and 3
// dimensions, and the hull (one number of keyshapes). `points`: #frames by #axes. Every
// `every`-th frame is measured. At most `steps` numbers a curve.
std::vector<ErrorCurve> error_curves(const FrameMatrixD& points, const FrameMatrixD& offsets,
                                     int channels_per_group, const KeyshapeOptions& options,
                                     int every, int steps);

// The curves as an SVG picture, and as a table between tabs (method, count, mean_square).
std::string error_plot_svg(const std::vector<ErrorCurve>& curves, const std::string& unit);
std::string error_table_tsv(const std::vector<ErrorCurve>& curves);

} // namespace phonomime
