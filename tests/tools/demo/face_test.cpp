// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/shared_data.h"
#include "tools/demo/marker_layout.h"
#include "tools/demo/mask_face.h"

namespace phonomime::demo {
namespace {

void expect_lips_closed(const MarkerPose& rest) {
  for (const LipColumn& column : kLipColumns)
    EXPECT_EQ(rest.row(marker_index(column.upper_inner)),
              rest.row(marker_index(column.lower_inner)));
}

double eye_distance_mm(const MarkerPose& rest) {
  return (rest.row(marker_index(33)) - rest.row(marker_index(263))).norm();
}

// Number of closed boundary loops of a mesh; -1 where an edge has more than two triangles.
int boundary_loops(const FaceMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      ++uses[std::minmax(t[i], t[(i + 1) % 3])];
  std::map<int, std::vector<int>> next;
  for (const auto& [edge, count] : uses) {
    if (count > 2)
      return -1;
    if (count == 1) {
      next[edge.first].push_back(edge.second);
      next[edge.second].push_back(edge.first);
    }
  }
  std::set<int> seen;
  int loops = 0;
  for (const auto& [start, unused] : next) {
    if (!seen.insert(start).second)
      continue;
    ++loops;
    std::vector<int> open = {start};
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      for (const int other : next[at])
        if (seen.insert(other).second)
          open.push_back(other);
    }
  }
  return loops;
}

TEST(Layout, Has91MarkersWithTheirRegionsAndLandmarks) {
  const Layout layout = marker_layout();
  EXPECT_EQ(layout.group_count(), 91);
  std::set<std::string> names;
  for (const ChannelGroup& group : layout.groups) {
    names.insert(group.name);
    EXPECT_FALSE(group.regions.empty());
  }
  EXPECT_EQ(names.size(), 91u);
  EXPECT_EQ(layout.groups_in(Region::lips).size(), 40u);
  EXPECT_EQ(layout.groups_in(Region::rigid).size(), 10u);
  for (const auto& [landmark, group] : layout.landmarks)
    EXPECT_TRUE(names.contains(group)) << landmark;
  const Layout read_back = parse_layout(format_layout(layout), "layout.json");
  EXPECT_EQ(read_back.group_count(), 91);
  EXPECT_EQ(read_back.landmarks, layout.landmarks);
}

TEST(Face, MaskIsAMeshWithOpenMouthAndEyes) {
  const FaceMesh mesh = mask_mesh();
  EXPECT_EQ(mesh.vertices_mm.size(), 91u);
  EXPECT_EQ(boundary_loops(mesh), 4) << "outline, mouth and two eyes";
  std::set<int> used;
  for (const auto& t : mesh.triangles)
    used.insert(t.begin(), t.end());
  EXPECT_EQ(used.size(), 91u);
  // Euler: V - E + F = 1 - 3 holes.
  std::set<std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
  EXPECT_EQ(91 - static_cast<int>(edges.size()) + static_cast<int>(mesh.triangles.size()), -2);
}

TEST(Face, MaskRestsWithClosedLipsAndUsualEyes) {
  const FaceModel model = mask_face_model();
  expect_lips_closed(model.rest);
  EXPECT_NEAR(eye_distance_mm(model.rest), 90.0, 2.0);
}

TEST(Face, CanonicalFaceRestsWithClosedLips) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const auto path = shared / "faces" / "canonical" / "canonical_face_model.obj";
  const std::string text = read_file(path);
  const FaceMesh mesh = parse_canonical_face(text, path.string());
  const FaceModel model = canonical_face_model(text, path.string());
  EXPECT_GT(mesh.vertices_mm[13].y() - mesh.vertices_mm[14].y(), 5.0);
  expect_lips_closed(model.rest);
  EXPECT_NEAR(eye_distance_mm(model.rest), 90.0, 2.0);
  // Only the lips have moved.
  for (const int vertex : marker_vertices())
    if (!marker_layout().groups[static_cast<std::size_t>(marker_index(vertex))].in(Region::lips)) {
      EXPECT_EQ(Eigen::Vector3d(model.rest.row(marker_index(vertex))),
                mesh.vertices_mm[static_cast<std::size_t>(vertex)]);
    }
}

TEST(Face, WrongMeshIsRefused) {
  EXPECT_THROW(parse_canonical_face("v 1 2 3\nf 1 1 1\n", "a.obj"), InputError);
  EXPECT_THROW(parse_canonical_face("v 1 2 x\n", "a.obj"), InputError);
  EXPECT_THROW(parse_canonical_face("f 0 1 2\n", "a.obj"), InputError);
  EXPECT_THROW(parse_canonical_face("v 1 2\n", "a.obj"), InputError);
}

} // namespace
} // namespace phonomime::demo
