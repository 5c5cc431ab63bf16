// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/marker_layout.h"

#include <algorithm>

#include "db/types/errors.h"

namespace phonomime::demo {

namespace {

struct RegionTable {
  std::vector<Region> regions;
  std::vector<int> vertices;
};

// The eye corners, the nose's bridge and the forehead's middle move with the skull alone.
const std::vector<RegionTable>& region_tables() {
  static const std::vector<RegionTable> tables = {
      {{Region::lips}, {61,  185, 40,  39,  37,  0,   267, 269, 270, 409, 291, 146, 91,  181,
                        84,  17,  314, 405, 321, 375, 78,  191, 80,  81,  82,  13,  312, 311,
                        310, 415, 308, 95,  88,  178, 87,  14,  317, 402, 318, 324}},
      {{Region::jaw}, {152, 148, 377, 176, 400, 150, 379, 136, 365, 172, 397}},
      {{Region::cheeks}, {50, 280, 205, 425, 187, 411, 207, 427, 216, 436}},
      {{Region::nose}, {1, 4, 5, 2, 98, 327}},
      {{Region::nose, Region::rigid}, {195, 197, 6, 168}},
      {{Region::brows}, {70, 63, 105, 66, 107, 336, 296, 334, 293, 300}},
      {{Region::eyelids}, {159, 145, 386, 374}},
      {{Region::eyelids, Region::rigid}, {33, 133, 362, 263}},
      {{Region::forehead, Region::rigid}, {10, 151}}};
  return tables;
}

std::vector<int> collect_vertices() {
  std::vector<int> vertices;
  for (const RegionTable& table : region_tables())
    vertices.insert(vertices.end(), table.vertices.begin(), table.vertices.end());
  return vertices;
}

} // namespace

std::span<const int> marker_vertices() {
  static const std::vector<int> vertices = collect_vertices();
  return vertices;
}

int marker_index(int vertex) {
  const std::span<const int> vertices = marker_vertices();
  const auto found = std::find(vertices.begin(), vertices.end(), vertex);
  if (found == vertices.end())
    throw InternalError({.what = "vertex " + std::to_string(vertex) + " carries no marker"});
  return static_cast<int>(found - vertices.begin());
}

std::string marker_name(int vertex) {
  return "lm" + std::to_string(vertex);
}

Layout marker_layout() {
  Layout layout;
  layout.reference = marker_name(168);
  for (const RegionTable& table : region_tables())
    for (const int vertex : table.vertices)
      layout.groups.push_back({.name = marker_name(vertex), .regions = table.regions});
  layout.landmarks = {{"lip_upper_inner", marker_name(13)},
                      {"lip_lower_inner", marker_name(14)},
                      {"mouth_corner_right", marker_name(kOuterCornerRight)},
                      {"mouth_corner_left", marker_name(kOuterCornerLeft)},
                      {"lip_upper_outer", marker_name(0)},
                      {"lip_lower_outer", marker_name(17)},
                      {"chin", marker_name(152)},
                      {"nose_tip", marker_name(1)},
                      {"eye_outer_right", marker_name(33)},
                      {"eye_outer_left", marker_name(263)}};
  return layout;
}

} // namespace phonomime::demo
