// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/triangle_mesh.h"

#include <Eigen/Geometry>

namespace phonomime {

TriangleMesh without_triangles(TriangleMesh mesh, const std::vector<char>& out) {
  Triangles kept(mesh.triangle_count(), 3);
  int count = 0;
  for (MeshPart& part : mesh.parts) {
    const int first = part.first_triangle;
    const int past = first + part.triangle_count;
    part.first_triangle = count;
    for (int t = first; t < past; ++t) {
      if (out[static_cast<std::size_t>(t)] == 0) {
        kept.row(count++) = mesh.triangles.row(t);
      }
    }
    part.triangle_count = count - part.first_triangle;
  }
  mesh.triangles = kept.topRows(count);
  return mesh;
}

Points vertex_normals(const Points& positions, const Triangles& triangles) {
  Points normals = Points::Zero(positions.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector3d a = positions.row(triangles(t, 0));
    const Eigen::RowVector3d b = positions.row(triangles(t, 1));
    const Eigen::RowVector3d c = positions.row(triangles(t, 2));
    const Eigen::RowVector3d doubled_area = (b - a).cross(c - a);
    for (int corner = 0; corner < 3; ++corner) {
      normals.row(triangles(t, corner)) += doubled_area;
    }
  }
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    const double length = normals.row(v).norm();
    if (length > 1e-12) {
      normals.row(v) /= length;
    } else {
      normals.row(v) = Eigen::RowVector3d::UnitZ();
    }
  }
  return normals;
}

} // namespace phonomime
