// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <filesystem>
#include <string_view>

namespace phonomime {

// A mesh by its file's suffix: .obj or .glb. Throws InputError and IoError.
TriangleMesh read_mesh(const std::filesystem::path& path);

// Wavefront OBJ: positions and faces (`v`, `v/vt`, `v//vn`, `v/vt/vn`, indices from the end where
// negative; polygons become fans). Everything else in it is passed over. One part, no material.
// `where` names the text in errors. Throws InputError.
TriangleMesh parse_obj(std::string_view text, std::string_view where);

// Binary glTF 2.0: one part for each primitive of each mesh in the default scene, in the order of
// the nodes, with the nodes' transforms applied. The first primitive is the skin. Morph targets,
// skins, pictures and animations are passed over; sparse or compressed positions are refused.
// Throws InputError.
TriangleMesh parse_glb(std::string_view bytes, std::string_view where);

} // namespace phonomime
