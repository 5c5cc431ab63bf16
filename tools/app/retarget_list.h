// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/face_scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

struct RetargetListOptions {
  std::filesystem::path face;
  std::filesystem::path database; // whose markers are looked for; empty: none
};

// What a face offers to be moved by.
struct FaceOffer {
  struct Shape {
    std::string name;
    std::string arkit;      // the shape of ARKit that its name means; may be empty
    double extent_mm = 0.0; // how far it moves the vertex that it moves most
  };

  std::filesystem::path file;
  std::vector<SceneMesh> meshes;
  std::vector<SceneNode> nodes;
  std::vector<Shape> shapes;
  std::size_t arkit_shapes = 0; // how many of ARKit's 52 there are

  std::string marker_table; // file, or empty
  std::optional<std::size_t>
      placed;                       // markers that the table places, or of the database those found
  std::vector<std::string> missing; // markers of the database that are not on the face
  std::vector<std::string> unknown; // of the table, not in the database
};

// Throws InputError and IoError.
FaceOffer list_face(const RetargetListOptions& options);

} // namespace phonomime
