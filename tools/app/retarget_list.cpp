// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_list.h"

#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "db/types/live_link_columns.h"
#include "db/types/text.h"
#include "synth/retarget/face_source.h"
#include "synth/retarget/marker_map.h"
#include "synth/retarget/shape_names.h"

#include <set>
#include <utility>

namespace phonomime {

namespace {

constexpr double kMillimetresPerMetre = 1000.0; // glTF is in metres

void list_shapes(const ShapeFace& face, FaceOffer& offer) {
  const std::vector<double> extents = shape_extents(face);
  std::set<std::size_t> arkit;
  for (std::size_t i = 0; i < face.names.size(); ++i) {
    const std::optional<std::size_t> meant = arkit_shape(face.names[i]);
    if (meant) {
      arkit.insert(*meant);
    }
    offer.shapes.push_back({.name = face.names[i],
                            .arkit = meant ? std::string(kLiveLinkColumns[*meant]) : "",
                            .extent_mm = extents[i] * kMillimetresPerMetre});
  }
  offer.arkit_shapes = arkit.size();
}

void list_markers(const RetargetListOptions& options, int skin_vertices, FaceOffer& offer) {
  const std::vector<std::filesystem::path> files = face_files(options.face);
  if (files.size() > 1) {
    offer.marker_table = files.back().string();
  }
  if (!options.database.empty()) {
    const Layout layout = MotionDatabase::open(options.database, OpenMode::read_only).info().layout;
    if (std::optional<MarkerMap> map = find_markers(options.face, layout, skin_vertices)) {
      offer.placed = layout.groups.size() - map->missing.size();
      offer.missing = std::move(map->missing);
      offer.unknown = std::move(map->unknown);
    }
  } else if (files.size() > 1) {
    offer.placed =
        parse_marker_table(read_file(files.back()), offer.marker_table, skin_vertices).size();
  }
}

} // namespace

FaceOffer list_face(const RetargetListOptions& options) {
  FaceScene scene = read_face_scene(options.face);
  FaceOffer offer;
  offer.file = scene.face.neutral.source;
  list_shapes(scene.face, offer);
  list_markers(options, scene.face.neutral.skin_vertex_count(), offer);
  offer.meshes = std::move(scene.meshes);
  offer.nodes = std::move(scene.nodes);
  return offer;
}

} // namespace phonomime
