// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/demo/face_mesh.h"
#include "tools/demo/rest_pose.h"

namespace phonomime::demo {

// A face that can carry the demo's markers.
struct FaceModel {
  MarkerPose rest;                // #markers by 3, mm, lips closed
  std::string obj_text;           // its mesh, for the corpus folder (centimetres)
  std::vector<int> marker_vertex; // #markers, into the mesh's vertices, from 0
};

// The canonical face from the text of its OBJ. Throws InputError.
FaceModel canonical_face_model(std::string_view obj_text, std::string_view where);

// Where the canonical face is not to be had: the markers themselves, placed on a parametric head
// (an ellipsoid with bumps for nose, lips and chin), and the mask they span. Vertex i of its mesh
// is marker i; mouth and eyes are open.
FaceModel mask_face_model();

// The mask's mesh, lips closed.
FaceMesh mask_mesh();

} // namespace phonomime::demo
