// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "synth/retarget/triangle_mesh.h"

#include <initializer_list>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace phonomime::test {

// One part, all of it skin.
inline TriangleMesh as_mesh(const Points& positions, const Triangles& triangles) {
  TriangleMesh mesh;
  mesh.source = "made.obj";
  mesh.positions = positions;
  mesh.triangles = triangles;
  mesh.parts = {{.vertex_count = mesh.vertex_count(), .triangle_count = mesh.triangle_count()}};
  return mesh;
}

// A grid of `columns` by `rows` vertices, 1 mm apart, numbered along x first; lower left at the
// origin. `jitter_mm` moves each vertex at random (by `seed`), in all three axes.
inline TriangleMesh grid(int columns, int rows, double jitter_mm = 0.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-jitter_mm, jitter_mm);
  Points positions(columns * rows, 3);
  for (int v = 0; v < columns * rows; ++v) {
    positions.row(v) << v % columns + jitter(random), v / columns + jitter(random), jitter(random);
  }
  Triangles triangles((columns - 1) * (rows - 1) * 2, 3);
  int t = 0;
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      const int a = y * columns + x;
      triangles.row(t++) << a, a + 1, a + columns;
      triangles.row(t++) << a + 1, a + columns + 1, a + columns;
    }
  }
  return as_mesh(positions, triangles);
}

struct MadeMarker {
  std::string name;
  std::vector<Region> regions;
  std::string landmark;
};

inline Layout made_layout(const std::vector<MadeMarker>& markers) {
  Layout layout;
  for (const MadeMarker& marker : markers) {
    layout.groups.push_back({marker.name, marker.regions});
    if (!marker.landmark.empty()) {
      layout.landmarks[marker.landmark] = marker.name;
    }
  }
  return layout;
}

// The positions of some vertices as a frame of markers: x, y, z of each in turn.
inline Eigen::VectorXd as_frame(const Points& positions, const std::vector<int>& vertices) {
  Eigen::VectorXd frame(3 * static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t g = 0; g < vertices.size(); ++g) {
    frame.segment<3>(3 * static_cast<Eigen::Index>(g)) = positions.row(vertices[g]).transpose();
  }
  return frame;
}

} // namespace phonomime::test
