// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/demo/face_mesh.h"

#include <Eigen/Core>

namespace phonomime::demo {

// #markers by 3, mm, in the order of marker_vertices().
using MarkerPose = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// The markers of the face at rest, mouth closed. The canonical face rests with its lips 6 mm apart:
// in each lip column the two inner markers go to the point between them, and each outer marker
// goes 0.8 of its inner neighbour's way. No other marker moves.
MarkerPose closed_rest_pose(const FaceMesh& canonical);

} // namespace phonomime::demo
