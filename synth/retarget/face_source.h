// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "synth/retarget/marker_map.h"
#include "synth/retarget/triangle_mesh.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace phonomime {

// A face as it lies on disk: a mesh and the place of each marker on its skin.
struct FaceSource {
  TriangleMesh mesh;
  MarkerMap markers;
};

// Reads what a person names with `--face PATH`. A folder: its only .glb, else its only .obj (a GLB
// may hold teeth and eyes); a file: that mesh. The markers are placed by `markers.tsv` beside the
// mesh, else by their names (marker_map_from_names). Throws InputError (what was looked for and
// what was found) and IoError.
FaceSource read_face(const std::filesystem::path& path, const Layout& layout);

// Where a layout's markers sit on that face, whose skin has so many vertices: nothing where neither
// a table nor their names say it. Throws InputError, as parse_marker_map, and IoError.
std::optional<MarkerMap> find_markers(const std::filesystem::path& path, const Layout& layout,
                                      int skin_vertices);

// The same, of which there has to be one. Throws as read_face.
MarkerMap read_markers(const std::filesystem::path& path, const Layout& layout, int skin_vertices);

// The files that read_face reads for a path: the mesh, then its marker table where there is one.
// Throws as read_face does where there is no mesh to read.
std::vector<std::filesystem::path> face_files(const std::filesystem::path& path);

} // namespace phonomime
