// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/shape_face.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// A node of a scene, each after its parent.
struct SceneNode {
  std::string name; // may be empty
  int parent = -1;  // into FaceScene::nodes, -1 = none
  int mesh = -1;    // into FaceScene::meshes, -1 = none
};

// A mesh as a node of the scene shows it.
struct SceneMesh {
  std::string name;                // may be empty
  std::vector<std::string> shapes; // its morph targets, in the file's order
  int vertices = 0;
  int triangles = 0;
};

// All that a face's file offers. The face may be without shapes.
struct FaceScene {
  ShapeFace face;
  std::vector<SceneMesh> meshes;
  std::vector<SceneNode> nodes;
};

// A GLB as parse_glb reads it, with its morph targets as shapes: offsets turned and scaled by the
// nodes' transforms, dense or sparse. Names are `extras.targetNames`, and where there
// are none `mesh0_target3` (both counted from 0); shapes that several meshes name
// alike are one. Throws InputError: as parse_glb, two targets of a mesh with one name, names that
// are more or fewer than the targets, offsets that do not fit the vertices.
FaceScene parse_face_scene(std::string_view bytes, std::string_view where);

// The file that `--face PATH` names (face_files): a GLB, or an OBJ, which has no shapes. Throws
// InputError and IoError.
FaceScene read_face_scene(const std::filesystem::path& path);

// The same, of which shapes are needed: throws InputError where there is none, or none that moves
// anything.
ShapeFace read_shape_face(const std::filesystem::path& path);

// How far each shape at weight 1 moves the vertex that it moves most: #shapes, the face's unit.
std::vector<double> shape_extents(const ShapeFace& face);

} // namespace phonomime
