// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/opening_cut.h"

#include "synth/retarget/edge_graph.h"
#include "synth/retarget/mesh_reader.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/made_mesh.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Closed loops of edges that only one triangle has.
int boundary_loops(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> count;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      ++count[std::minmax({triangles(t, corner), triangles(t, (corner + 1) % 3)})];
    }
  }
  std::map<int, int> parent;
  const auto root = [&](int v) {
    while (parent.at(v) != v) {
      v = parent.at(v);
    }
    return v;
  };
  for (const auto& [edge, uses] : count) {
    if (uses == 1) {
      parent.emplace(edge.first, edge.first);
      parent.emplace(edge.second, edge.second);
      parent[root(edge.first)] = root(edge.second);
    }
  }
  return static_cast<int>(
      std::ranges::count_if(parent, [](const auto& entry) { return entry.first == entry.second; }));
}

int filling(const OpeningFill& fill) {
  return std::accumulate(fill.filling.begin(), fill.filling.end(), 0);
}

// The grid's marker vertices: a mouth 20 mm wide and 4 mm high whose markers are not numbers.
const Layout kMouth = test::made_layout({{"right", {Region::lips}, "mouth_corner_right"},
                                         {"upper", {Region::lips}, "lip_upper_inner"},
                                         {"left", {Region::lips}, "mouth_corner_left"},
                                         {"lower", {Region::lips}, "lip_lower_inner"}});
constexpr int kColumns = 41;
const std::vector<int> kMouthVertices = {10 * kColumns + 10, 12 * kColumns + 20, 10 * kColumns + 30,
                                         8 * kColumns + 20};

TEST(OpeningCut, CutsWhatLiesBetweenTheMarkersOfAFilledMouth) {
  const TriangleMesh mesh = test::grid(kColumns, 21);
  const OpeningFill fill = find_opening_fill(mesh, mesh.positions, kMouth, kMouthVertices);
  ASSERT_EQ(fill.openings.size(), 1u);
  EXPECT_EQ(fill.openings[0].name, "mouth");
  EXPECT_EQ(fill.openings[0].triangles, filling(fill));
  // The quadrangle of the markers has 40 mm^2, a triangle half a square millimetre.
  EXPECT_NEAR(filling(fill), 80, 20);
  const TriangleMesh cut = without_triangles(mesh, fill.filling);
  EXPECT_EQ(cut.positions, mesh.positions);
  EXPECT_EQ(cut.triangle_count() + filling(fill), mesh.triangle_count());
  EXPECT_EQ(boundary_loops(cut.triangles), 2);
  const EdgeGraph graph(cut.positions, cut.triangles);
  EXPECT_GT(graph.path_length(graph.shortest_path(kMouthVertices[1], kMouthVertices[3])), 16.0)
      << "from lip to lip the way leads round a corner";
  // An open mouth stays as it is.
  const OpeningFill again = find_opening_fill(cut, cut.positions, kMouth, kMouthVertices);
  EXPECT_EQ(filling(again), 0);
  EXPECT_TRUE(again.openings.empty());
}

TEST(OpeningCut, FindsTheEyesBySide) {
  const TriangleMesh mesh = test::grid(kColumns, 21);
  std::vector<test::MadeMarker> markers;
  std::vector<int> vertices;
  const auto add = [&](int x, int y) {
    markers.push_back({"lid_" + std::to_string(vertices.size()) + "x", {Region::eyelids}, ""});
    vertices.push_back(y * kColumns + x);
  };
  for (const int centre : {8, 32}) {
    add(centre - 6, 10);
    add(centre, 13);
    add(centre + 6, 10);
    add(centre, 7);
  }
  const OpeningFill fill =
      find_opening_fill(mesh, mesh.positions, test::made_layout(markers), vertices);
  ASSERT_EQ(fill.openings.size(), 2u);
  EXPECT_EQ(fill.openings[0].name, "right eye");
  EXPECT_EQ(fill.openings[1].name, "left eye");
  EXPECT_EQ(boundary_loops(without_triangles(mesh, fill.filling).triangles), 3);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const double x = mesh.positions(mesh.triangles(t, 0), 0);
    if (fill.filling[static_cast<std::size_t>(t)] != 0) {
      EXPECT_TRUE((x >= 2 && x <= 14) || (x >= 26 && x <= 38)) << x;
    }
  }
}

TEST(OpeningCut, NeedsItsMarkers) {
  const TriangleMesh mesh = test::grid(kColumns, 21);
  std::vector<int> vertices = kMouthVertices;
  vertices[0] = -1;
  EXPECT_EQ(filling(find_opening_fill(mesh, mesh.positions, kMouth, vertices)), 0);
}

// A mesh with the canonical face's ring round the mouth: a fan inside, a belt outside.
TEST(OpeningCut, CutsInsideTheRingsOfTheCanonicalNumbering) {
  const std::vector<int> ring = {78,  95,  88,  178, 87,  14, 317, 402, 318, 324,
                                 308, 415, 310, 311, 312, 13, 82,  81,  80,  191};
  Points positions = Points::Zero(468, 3);
  std::vector<Eigen::RowVector3i> triangles;
  const int n = static_cast<int>(ring.size());
  for (int i = 0; i < n; ++i) {
    const double angle =
        std::numbers::pi + 2.0 * std::numbers::pi * i / n; // from the right corner down
    const Eigen::RowVector3d at(25.0 * std::cos(angle), 5.0 * std::sin(angle), 0.0);
    const auto vertex = [&](int k) { return ring[static_cast<std::size_t>(k % n)]; };
    const auto outside = [&](int k) { return 440 + k % n; };
    positions.row(vertex(i)) = at;
    positions.row(outside(i)) = 2.0 * at;
    if (i > 0 && i + 1 < n) {
      triangles.emplace_back(vertex(0), vertex(i), vertex(i + 1));
    }
    triangles.emplace_back(vertex(i), outside(i), outside(i + 1));
    triangles.emplace_back(vertex(i), outside(i + 1), vertex(i + 1));
  }
  Triangles all(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    all.row(static_cast<Eigen::Index>(t)) = triangles[t];
  }
  const TriangleMesh mesh = test::as_mesh(positions, all);
  const Layout layout = test::made_layout({{"lm78", {}, "mouth_corner_right"},
                                           {"lm13", {}, "lip_upper_inner"},
                                           {"lm308", {}, "mouth_corner_left"},
                                           {"lm14", {}, "lip_lower_inner"}});
  const OpeningFill fill =
      find_opening_fill(mesh, positions, layout, std::vector<int>{78, 13, 308, 14});
  EXPECT_EQ(filling(fill), n - 2);
  const TriangleMesh cut = without_triangles(mesh, fill.filling);
  EXPECT_EQ(cut.triangle_count(), 2 * n);
  EXPECT_EQ(boundary_loops(cut.triangles), 2);
  EXPECT_EQ(filling(find_opening_fill(cut, positions, layout, std::vector<int>{78, 13, 308, 14})),
            0);
}

TEST(OpeningCut, OpensTheMouthAndTheEyesOfTheCanonicalFace) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const TriangleMesh mesh = read_mesh(data / "faces/canonical/canonical_face_model.obj");
  const std::vector<int> vertices = {61, 13, 291, 14, 33, 159, 133, 145, 263, 386, 362, 374};
  std::vector<test::MadeMarker> markers;
  for (const int vertex : vertices) {
    markers.push_back(
        {"lm" + std::to_string(vertex), {markers.size() < 4 ? Region::lips : Region::eyelids}, ""});
  }
  markers[0].landmark = "mouth_corner_right";
  markers[1].landmark = "lip_upper_inner";
  markers[2].landmark = "mouth_corner_left";
  markers[3].landmark = "lip_lower_inner";
  ASSERT_EQ(boundary_loops(mesh.triangles), 1) << "only the outline";
  const OpeningFill fill =
      find_opening_fill(mesh, mesh.positions, test::made_layout(markers), vertices);
  const TriangleMesh cut = without_triangles(mesh, fill.filling);
  EXPECT_EQ(boundary_loops(cut.triangles), 4) << "the outline, the mouth and two eyes";
  EXPECT_EQ(filling(fill), 18 + 14 + 14)
      << "polygons of 20, 16 and 16 corners without inner vertices";
}

} // namespace
} // namespace phonomime
