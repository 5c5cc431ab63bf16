// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// #points by 3.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
// #triangles by 3, into the points.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

// What a surface looks like: the part of glTF's metallic-roughness model without pictures.
struct MeshMaterial {
  std::string name;
  std::array<double, 4> base_color = {1.0, 1.0, 1.0, 1.0}; // linear RGBA
  double metallic = 0.0;
  double roughness = 1.0;
  bool double_sided = false;
};

// A run of vertices and of the triangles between them. Parts share no vertex.
struct MeshPart {
  int first_vertex = 0;
  int vertex_count = 0;
  int first_triangle = 0;
  int triangle_count = 0;
  int material = -1; // into TriangleMesh::materials, -1 = none
};

// A face as its file gives it. Part 0 is the skin, the one that markers move; the others are what a
// head has besides (teeth, gums, eyes, lashes).
struct TriangleMesh {
  std::string source;  // path, for messages
  Points positions;    // the file's own unit and axes
  Triangles triangles; // no triangle names a vertex twice
  std::vector<MeshPart> parts;
  std::vector<MeshMaterial> materials;

  int vertex_count() const { return static_cast<int>(positions.rows()); }
  int triangle_count() const { return static_cast<int>(triangles.rows()); }
  int skin_vertex_count() const { return parts.front().vertex_count; }
};

// The mesh without the triangles that are marked (#triangles, 1 = out). Vertices keep their
// numbers.
TriangleMesh without_triangles(TriangleMesh mesh, const std::vector<char>& out);

// Unit normals weighted by the area of the triangles around each vertex: #points by 3; (0, 0, 1)
// where a vertex has none.
Points vertex_normals(const Points& positions, const Triangles& triangles);

} // namespace phonomime
