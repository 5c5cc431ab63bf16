// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/select_keyshapes.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/retarget/keyshapes/cluster_frames.h"
#include "synth/retarget/keyshapes/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace phonomime {
namespace {

KeyshapeSelection extrema(const FrameMatrixD& points, const KeyshapeOptions& options) {
  KeyshapeSelection selection;
  const FrameMatrixD centred = points.rowwise() - points.colwise().mean();
  const double spread = std::sqrt(centred.squaredNorm() /
                                  static_cast<double>(std::max<Eigen::Index>(points.rows(), 1)));
  const double threshold = options.similar * spread;
  const auto is_full = [&] { return std::ssize(selection.chosen) >= options.count; };
  for (int axis = 0; axis < points.cols() && !is_full(); ++axis) {
    for (const bool largest : {true, false}) {
      if (is_full()) {
        break;
      }
      Keyshape candidate{.axis = axis, .largest = largest};
      if (largest) {
        points.col(axis).maxCoeff(&candidate.frame);
      } else {
        points.col(axis).minCoeff(&candidate.frame);
      }
      std::size_t like = 0;
      double distance = 0.0;
      for (; like < selection.chosen.size(); ++like) {
        const Eigen::Index other = selection.chosen[like].frame;
        distance = (points.row(candidate.frame) - points.row(other)).norm();
        if (other == candidate.frame || distance < threshold) {
          break;
        }
      }
      if (like == selection.chosen.size()) {
        selection.chosen.push_back(candidate);
      } else {
        selection.left_out.push_back({candidate, like, distance});
      }
    }
  }
  return selection;
}

KeyshapeSelection as_selection(const std::vector<Eigen::Index>& frames) {
  KeyshapeSelection selection;
  for (const Eigen::Index frame : frames) {
    selection.chosen.push_back({.frame = frame});
  }
  return selection;
}

} // namespace

void KeyshapeOptions::validate() const {
  if (count < 1 || count > 1000) {
    throw UsageError({.what = "the number of keyshapes is out of range",
                      .expected = "1 to 1000",
                      .got = std::to_string(count)});
  }
  if (!(similar >= 0.0) || std::isinf(similar)) {
    throw UsageError({.what = "the distance of similar keyshapes is out of range",
                      .expected = "a share of the frames' spread, from 0 on",
                      .got = format_number(similar)});
  }
  if (cluster_dimensions < 1) {
    throw UsageError({.what = "the number of dimensions to cluster in is out of range",
                      .expected = "1 or more",
                      .got = std::to_string(cluster_dimensions)});
  }
}

KeyshapeSelection select_keyshapes(const FrameMatrixD& points, const KeyshapeOptions& options) {
  options.validate();
  if (points.rows() == 0 || points.cols() == 0) {
    return {};
  }
  switch (options.method) {
  case KeyshapeMethod::hull:
    return as_selection(convex_hull(points));
  case KeyshapeMethod::clusters:
    return as_selection(cluster_frames(
        points.leftCols(std::min<Eigen::Index>(options.cluster_dimensions, points.cols())),
        options.count, options.seed));
  case KeyshapeMethod::extrema:
    break;
  }
  return extrema(points, options);
}

} // namespace phonomime
