// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace phonomime {

// Collects arrays, meshes and nodes of a glTF file and writes it as one GLB. All indices are glTF's
// own; arrays are given in the file's units.
class GltfBuilder {
public:
  GltfBuilder(std::string title, const std::vector<std::string>& credits, bool synthetic);
  ~GltfBuilder();

  // Accessors. Vertex arrays: #vertices by 3, with bounds.
  int add_vertices(const Points& values);
  int add_indices(std::span<const std::uint32_t> values);
  // #rows times `width` (1, 3 or 4) floats for an animation; times get bounds.
  int add_keys(std::span<const float> values, int width);

  int add_material(const MeshMaterial& material);

  struct Primitive {
    int positions = -1;
    int normals = -1;
    int indices = -1;
    int material = -1;
    struct Target {
      int positions = -1;
      int normals = -1;
    };
    std::vector<Target> targets;
  };
  // `weights` and `target_names`: one for each target, empty where there is none.
  int add_mesh(std::string name, const std::vector<Primitive>& primitives,
               const std::vector<double>& weights, const std::vector<std::string>& target_names);

  int add_node(std::string name, int mesh, int parent = -1);
  void place_node(int node, const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation);

  // `path`: "weights", "translation" or "rotation".
  void animate(int node, std::string path, int times, int values);

  std::string finish();

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace phonomime
