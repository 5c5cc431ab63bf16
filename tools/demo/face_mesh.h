// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace phonomime::demo {

// A face in mm: x to the right of the picture, y up, z towards the viewer.
struct FaceMesh {
  std::vector<Eigen::Vector3d> vertices_mm;
  std::vector<std::array<int, 3>> triangles; // into vertices_mm, counter-clockwise from outside
};

// Number of vertices of the canonical face mesh (MediaPipe's topology).
inline constexpr int kCanonicalVertexCount = 468;

// The canonical face mesh from the text of its OBJ, which is in centimetres. `where` names the file
// in errors. Throws InputError where it is not a mesh of 468 vertices and triangles over them.
FaceMesh parse_canonical_face(std::string_view obj_text, std::string_view where);

// An OBJ in centimetres, as the canonical face is.
std::string format_obj(const FaceMesh& mesh, std::string_view comment);

} // namespace phonomime::demo
