// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <Eigen/Core>
#include <string>
#include <vector>

namespace phonomime {

// A face with blendshapes of its own: positions = neutral + sum over shapes of weight * offsets.
struct ShapeFace {
  TriangleMesh neutral;           // the file's own unit and axes
  std::vector<std::string> names; // of the shapes, as the file spells them; no two alike
  std::vector<Points> offsets;    // for each shape: #vertices by 3, the neutral's unit
};

} // namespace phonomime
