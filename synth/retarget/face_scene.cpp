// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/face_scene.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "synth/retarget/face_source.h"
#include "synth/retarget/mesh_reader.h"

#include <algorithm>

namespace phonomime {

FaceScene read_face_scene(const std::filesystem::path& path) {
  const std::filesystem::path file = face_files(path).front();
  if (to_lower(file.extension().string()) == ".glb") {
    return parse_face_scene(read_file(file), file.string());
  }
  FaceScene scene;
  scene.face.neutral = read_mesh(file);
  scene.meshes = {{.name = file.stem().string(),
                   .shapes = {},
                   .vertices = scene.face.neutral.vertex_count(),
                   .triangles = scene.face.neutral.triangle_count()}};
  return scene;
}

ShapeFace read_shape_face(const std::filesystem::path& path) {
  ShapeFace face = read_face_scene(path).face;
  if (face.names.empty()) {
    throw InputError({.where = face.neutral.source,
                      .what = "this face has no shapes of its own",
                      .expected = "a .glb whose mesh has morph targets",
                      .remedy = "Export it with its blendshapes (shape keys), or have `synth "
                                "--face` move it by its markers."});
  }
  if (std::ranges::all_of(shape_extents(face), [](double extent) { return extent == 0.0; })) {
    throw InputError({.where = face.neutral.source,
                      .what = "none of this face's shapes moves anything",
                      .remedy = "Export its blendshapes with their offsets."});
  }
  return face;
}

std::vector<double> shape_extents(const ShapeFace& face) {
  std::vector<double> extents;
  for (const Points& offsets : face.offsets) {
    extents.push_back(offsets.rows() == 0 ? 0.0 : offsets.rowwise().norm().maxCoeff());
  }
  return extents;
}

} // namespace phonomime
