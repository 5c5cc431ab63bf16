// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/face_source.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "synth/retarget/mesh_reader.h"

#include <algorithm>

namespace phonomime {
namespace {

constexpr std::string_view kMarkerTable = "markers.tsv";

std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder,
                                               std::string_view suffix) {
  std::vector<std::filesystem::path> found;
  std::error_code failure;
  for (std::filesystem::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    if (to_lower(entry->path().extension().string()) == suffix && entry->is_regular_file(failure)) {
      found.push_back(entry->path());
    }
  }
  if (failure) {
    throw IoError({.where = folder.string(),
                   .what = "cannot look into the folder",
                   .got = failure.message()});
  }
  std::ranges::sort(found);
  return found;
}

std::filesystem::path mesh_in(const std::filesystem::path& folder) {
  for (const std::string_view suffix : {".glb", ".obj"}) {
    const auto found = files_named(folder, suffix);
    if (found.size() > 1) {
      throw InputError({.where = folder.string(),
                        .what = "the folder holds several " + std::string(suffix) + " files",
                        .expected = "one",
                        .got = found[0].filename().string() + ", " + found[1].filename().string(),
                        .remedy = "Name the mesh itself instead of its folder."});
    }
    if (found.size() == 1) {
      return found.front();
    }
  }
  throw InputError({.where = folder.string(),
                    .what = "there is no face in this folder",
                    .expected = "a .glb or a .obj file"});
}

} // namespace

std::vector<std::filesystem::path> face_files(const std::filesystem::path& path) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) {
    throw IoError({.where = path.string(),
                   .what = "the face cannot be opened",
                   .expected = "a folder or a mesh",
                   .got = failure.message()});
  }
  std::vector<std::filesystem::path> files = {std::filesystem::is_directory(status) ? mesh_in(path)
                                                                                    : path};
  const std::filesystem::path table = files.front().parent_path() / kMarkerTable;
  if (std::filesystem::exists(table, failure)) {
    files.push_back(table);
  }
  return files;
}

std::optional<MarkerMap> find_markers(const std::filesystem::path& path, const Layout& layout,
                                      int skin_vertices) {
  const std::vector<std::filesystem::path> files = face_files(path);
  return files.size() > 1 ? parse_marker_map(read_file(files.back()), files.back().string(), layout,
                                             skin_vertices)
                          : marker_map_from_names(layout, skin_vertices);
}

MarkerMap read_markers(const std::filesystem::path& path, const Layout& layout, int skin_vertices) {
  std::optional<MarkerMap> markers = find_markers(path, layout, skin_vertices);
  if (!markers) {
    throw InputError(
        {.where = face_files(path).front().string(),
         .what = "nothing says where the markers sit on this face",
         .expected = "a table " + std::string(kMarkerTable) + " beside it",
         .remedy = "Write one line `marker<TAB>vertex` for each marker, vertices counted from 0."});
  }
  return std::move(*markers);
}

FaceSource read_face(const std::filesystem::path& path, const Layout& layout) {
  const std::filesystem::path mesh = face_files(path).front();
  if (layout.kind != LayoutKind::markers) {
    throw InputError({.where = path.string(),
                      .what = "a face that markers move needs a database of markers",
                      .got = "a database of weights"});
  }
  FaceSource face{.mesh = read_mesh(mesh), .markers = {}};
  face.markers = read_markers(path, layout, face.mesh.skin_vertex_count());
  return face;
}

} // namespace phonomime
