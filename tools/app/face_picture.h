// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// Draws poses of one mesh from the front (x to the right, y up, z towards the viewer), all alike
// framed: parallel rays, light from above.
class FacePainter {
public:
  // The mesh is kept by reference. `around`: places that are to be seen, with some margin (#places
  // by 3, the mesh's unit).
  FacePainter(const TriangleMesh& mesh, const Points& around);

  // The bytes of a PNG file of the mesh with other positions (#vertices by 3, its own unit). Throws
  // InternalError where they do not fit.
  std::string png(const Points& positions) const;

private:
  const TriangleMesh& mesh_;
  Eigen::Vector2d left_top_; // of the picture
  double pixel_ = 1.0;       // side, in the mesh's unit
  int width_px_ = 0, height_px_ = 0;
};

// Markers from the front as SVG: those of a part filled, the others hollow, with lines from where
// each is at rest. `rest`, `pose`: #channels, mm; `channels`: of the part.
std::string marker_picture(const Eigen::VectorXd& rest, const Eigen::VectorXd& pose,
                           const std::vector<int>& channels);

} // namespace phonomime
