// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/placement.h"
#include "synth/retarget/shape_face.h"

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// A face's blendshapes as markers on its skin would see them, the face placed on the markers at
// rest: in mm and in the axes of the markers' reference pose.
struct MarkerShapes {
  std::vector<std::string> names; // #shapes
  Eigen::MatrixXd offsets;        // #channels by #shapes; 0 for markers that are not on the face
  Eigen::VectorXd rest;           // #channels: the face's own neutral, NaN for those markers
  Eigen::VectorXd reference;      // #channels: the markers at rest
  std::vector<char> on_face;      // #markers
  Similarity placement;           // of the face onto the markers

  Eigen::Index channel_count() const { return offsets.rows(); }
  Eigen::Index shape_count() const { return offsets.cols(); }
};

// `marker_vertices`: #markers, into the face's vertices, -1 = not on this face. `reference_pose`:
// #channels (x, y, z of each marker in turn), mm. Throws InputError where the face has no shapes or
// does not lie under the markers (place_on_markers).
MarkerShapes shapes_at_markers(const ShapeFace& face, std::span<const int> marker_vertices,
                               const Eigen::VectorXd& reference_pose);

} // namespace phonomime
