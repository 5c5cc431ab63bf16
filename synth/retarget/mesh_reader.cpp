// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mesh_reader.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"

namespace phonomime {

TriangleMesh read_mesh(const std::filesystem::path& path) {
  const std::string suffix = to_lower(path.extension().string());
  if (suffix == ".obj") {
    return parse_obj(read_file(path), path.string());
  }
  if (suffix == ".glb") {
    return parse_glb(read_file(path), path.string());
  }
  throw InputError({.where = path.string(),
                    .what = "this is not a mesh that Phonomime reads",
                    .expected = "a file named .glb or .obj",
                    .got = quoted(suffix)});
}

} // namespace phonomime
