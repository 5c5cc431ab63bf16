// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <span>

namespace phonomime {

// y = scale * rotation * x + translation.
struct Similarity {
  double scale = 1.0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double rms = 0.0; // what the fit leaves: root of the mean squared distance, in the target's unit

  Points apply(const Points& points) const; // #points by 3
};

// The similarity (rotation, never a reflection) that brings `from` nearest to `to` in the sense of
// least squares (Umeyama 1991). Both #points by 3. Throws InternalError where they differ in size
// or are fewer than 3.
Similarity fit_similarity(const Points& from, const Points& to);

// The similarity that brings a face onto the markers at rest. `marker_vertices`: #markers, into the
// mesh's vertices, -1 = not on this face. `reference`: #markers by 3, mm. Throws InputError, which
// names the mesh, where what is left of the distances is too large a share of the markers' spread:
// another face, or other vertex numbers.
Similarity place_on_markers(const TriangleMesh& mesh, std::span<const int> marker_vertices,
                            const Points& reference);

} // namespace phonomime
