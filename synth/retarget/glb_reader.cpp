// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/face_scene.h"
#include "synth/retarget/glb_file.h"
#include "synth/retarget/mesh_reader.h"

#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace phonomime {
namespace {

constexpr std::size_t kMostShapes = 4096;
constexpr std::size_t kMostOffsets = 100'000'000; // vertices times shapes
constexpr double kLargestCoordinate = 1e9;
constexpr int kTriangles = 4; // glTF's default mode

MeshMaterial material_of(const tinygltf::Material& source) {
  const auto unit = [](double value) {
    return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0;
  };
  MeshMaterial material;
  material.name = source.name;
  const auto& surface = source.pbrMetallicRoughness;
  for (std::size_t i = 0; i < 4 && i < surface.baseColorFactor.size(); ++i) {
    material.base_color[i] = unit(surface.baseColorFactor[i]);
  }
  material.metallic = unit(surface.metallicFactor);
  material.roughness = unit(surface.roughnessFactor);
  material.double_sided = source.doubleSided;
  return material;
}

// Walks the nodes of a file's scene and joins what they show.
class SceneReader : GlbFile {
public:
  using GlbFile::GlbFile;

  // Shapes are read where `with_shapes` asks for them.
  FaceScene scene(bool with_shapes) {
    with_shapes_ = with_shapes;
    result_.source = where();
    for (const tinygltf::Material& material : model().materials) {
      result_.materials.push_back(material_of(material));
    }
    if (model().scenes.empty()) {
      fail("there is no scene in this file", "a scene with the face");
    }
    const std::size_t scene =
        model().defaultScene < 0 ? 0 : static_cast<std::size_t>(model().defaultScene);
    if (scene >= model().scenes.size()) {
      fail_index("scene", model().defaultScene, model().scenes.size());
    }
    visited_.assign(model().nodes.size(), 0);
    for (const int node : model().scenes[scene].nodes) {
      add_node(node, Eigen::Affine3d::Identity(), -1);
    }
    if (result_.parts.empty()) {
      fail("there is no mesh in this file's scene", "a face of triangles");
    }
    result_.positions = Eigen::Map<const Points>(
        coordinates_.data(), static_cast<Eigen::Index>(coordinates_.size() / 3), 3);
    result_.triangles = Eigen::Map<const Triangles>(
        corners_.data(), static_cast<Eigen::Index>(corners_.size() / 3), 3);
    FaceScene scene_read;
    scene_read.nodes = std::move(nodes_);
    scene_read.meshes = std::move(meshes_);
    scene_read.face.names = std::move(names_);
    for (std::vector<double>& offsets : offsets_) {
      offsets.resize(coordinates_.size(), 0.0); // parts after the last that has the shape
      scene_read.face.offsets.emplace_back(Eigen::Map<const Points>(
          offsets.data(), static_cast<Eigen::Index>(offsets.size() / 3), 3));
      offsets = {};
    }
    scene_read.face.neutral = std::move(result_);
    return scene_read;
  }

private:
  Eigen::Affine3d transform_of(const tinygltf::Node& node) const {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (node.matrix.size() == 16) {
      transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
      transform.makeAffine();
      return transform;
    }
    if (node.translation.size() == 3) {
      transform.translate(Eigen::Vector3d::Map(node.translation.data()));
    }
    if (node.rotation.size() == 4) {
      const auto& q = node.rotation;
      const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
      if (rotation.norm() < 1e-6) {
        fail("a node's rotation is not a quaternion of length 1");
      }
      transform.rotate(rotation.normalized());
    }
    if (node.scale.size() == 3) {
      transform.scale(Eigen::Vector3d::Map(node.scale.data()));
    }
    return transform;
  }

  // `above`: the parent, into nodes_.
  void add_node(int index, const Eigen::Affine3d& parent, int above) {
    const tinygltf::Node& node = at(model().nodes, index, "node");
    if (visited_[static_cast<std::size_t>(index)]++ != 0) {
      fail("the scene's nodes are not a tree", "each node once",
           "node " + std::to_string(index) + " again");
    }
    const Eigen::Affine3d transform = parent * transform_of(node);
    const int here = static_cast<int>(nodes_.size());
    nodes_.push_back({.name = node.name, .parent = above, .mesh = -1});
    if (node.mesh >= 0) {
      nodes_.back().mesh = static_cast<int>(meshes_.size());
      add_mesh(node.mesh, transform);
    }
    if (++depth_ > kDeepest) {
      fail("the scene's nodes are nested too deeply",
           "at most " + std::to_string(kDeepest) + " levels");
    }
    for (const int child : node.children) {
      add_node(child, transform, here);
    }
    --depth_;
  }

  void add_mesh(int index, const Eigen::Affine3d& transform) {
    const tinygltf::Mesh& mesh = at(model().meshes, index, "mesh");
    SceneMesh listed{.name = mesh.name};
    const std::size_t targets =
        mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
    if (with_shapes_) {
      listed.shapes = target_names(mesh, index, targets);
    }
    const std::vector<std::size_t> shapes = find_shapes(listed.shapes);
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (with_shapes_ && primitive.targets.size() != targets) {
        fail(fmt::format("the parts of mesh {} differ in the number of their morph targets",
                         quoted(mesh.name)),
             std::to_string(targets), std::to_string(primitive.targets.size()));
      }
      const std::size_t first = coordinates_.size();
      add_primitive(primitive, transform);
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        add_offsets(primitive.targets[k], first, transform.linear(), listed.shapes[k],
                    offsets_[shapes[k]]);
      }
      listed.vertices += result_.parts.back().vertex_count;
      listed.triangles += result_.parts.back().triangle_count;
    }
    meshes_.push_back(std::move(listed));
  }

  // Of a mesh's morph targets: `extras.targetNames`, as every exporter writes them; made up where
  // the mesh does not name them.
  std::vector<std::string> target_names(const tinygltf::Mesh& mesh, int index,
                                        std::size_t targets) const {
    if (targets > kMostShapes) {
      fail(fmt::format("mesh {} has too many morph targets", quoted(mesh.name)),
           fmt::format("at most {}", kMostShapes), std::to_string(targets));
    }
    std::vector<std::string> names;
    const tinygltf::Value& given =
        mesh.extras.IsObject() ? mesh.extras.Get("targetNames") : tinygltf::Value();
    if (given.IsArray() && given.ArrayLen() > 0 && given.ArrayLen() != targets) {
      fail(fmt::format("mesh {} does not name each of its morph targets", quoted(mesh.name)),
           fmt::format("{} targetNames", targets), std::to_string(given.ArrayLen()));
    }
    std::map<std::string, std::size_t, std::less<>> seen;
    for (std::size_t k = 0; k < targets; ++k) {
      const tinygltf::Value& value = given.IsArray() && given.ArrayLen() > 0
                                         ? given.Get(static_cast<int>(k))
                                         : tinygltf::Value();
      std::string name = value.IsString() ? value.Get<std::string>() : std::string();
      if (!is_valid_utf8(name)) {
        fail(fmt::format("the name of morph target {} of mesh {} is not UTF-8", k,
                         quoted(mesh.name)));
      }
      if (name.empty()) {
        name = fmt::format("mesh{}_target{}", index, k);
      }
      const auto [twin, is_new] = seen.emplace(name, k);
      if (!is_new) {
        fail(fmt::format("two morph targets of mesh {} have the name {}", quoted(mesh.name),
                         quoted(name)),
             "a name of its own for each", fmt::format("targets {} and {}", twin->second, k));
      }
      names.push_back(std::move(name));
    }
    return names;
  }

  // Into names_ and offsets_; new ones are added. Meshes share the shapes that they name alike.
  std::vector<std::size_t> find_shapes(const std::vector<std::string>& names) {
    std::vector<std::size_t> found;
    for (const std::string& name : names) {
      const auto known = shape_index_.emplace(name, names_.size()).first;
      if (known->second == names_.size()) {
        names_.push_back(name);
        offsets_.emplace_back();
      }
      found.push_back(known->second);
    }
    return found;
  }

  // The offsets of the vertices from coordinate `first` on; zero where the target has no positions.
  void add_offsets(const std::map<std::string, int>& target, std::size_t first,
                   const Eigen::Matrix3d& turn, const std::string& name,
                   std::vector<double>& offsets) const {
    if (coordinates_.size() / 3 * names_.size() > kMostOffsets) {
      fail("the morph targets are too large",
           fmt::format("at most {} vertices times targets", kMostOffsets));
    }
    offsets.resize(first, 0.0); // parts that do not have the shape
    const auto position = target.find("POSITION");
    if (position == target.end()) {
      offsets.resize(coordinates_.size(), 0.0);
      return;
    }
    const std::string what = "offsets of morph target " + quoted(name);
    const std::vector<float> values = vectors(position->second, what);
    if (first + values.size() != coordinates_.size()) {
      fail("the " + what + " are not one for each vertex",
           std::to_string((coordinates_.size() - first) / 3), std::to_string(values.size() / 3));
    }
    for (std::size_t i = 0; i < values.size(); i += 3) {
      const Eigen::Vector3d offset =
          turn * Eigen::Vector3d(values[i], values[i + 1], values[i + 2]);
      if (!offset.allFinite() || offset.cwiseAbs().maxCoeff() > kLargestCoordinate) {
        fail(fmt::format("number {} of the {} is not a usable one", i / 3, what));
      }
      offsets.insert(offsets.end(), {offset.x(), offset.y(), offset.z()});
    }
  }

  void add_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform) {
    if (primitive.mode != kTriangles && primitive.mode != -1) {
      fail("a mesh is not made of single triangles", "mode 4",
           "mode " + std::to_string(primitive.mode));
    }
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
      fail("a mesh has no positions");
    }
    MeshPart part;
    part.first_vertex = static_cast<int>(coordinates_.size() / 3);
    part.first_triangle = static_cast<int>(corners_.size() / 3);
    add_positions(elements(position->second, TINYGLTF_TYPE_VEC3, "positions"), transform);
    part.vertex_count = static_cast<int>(coordinates_.size() / 3) - part.first_vertex;
    if (primitive.indices >= 0) {
      const Elements indices = elements(primitive.indices, TINYGLTF_TYPE_SCALAR, "indices");
      add_triangles(part, indices.count, [&](std::size_t i) { return index_at(indices, i); });
    } else {
      add_triangles(part, static_cast<std::size_t>(part.vertex_count),
                    [](std::size_t i) { return i; });
    }
    part.triangle_count = static_cast<int>(corners_.size() / 3) - part.first_triangle;
    if (primitive.material >= 0) {
      at(model().materials, primitive.material, "material");
      part.material = primitive.material;
    }
    result_.parts.push_back(part);
  }

  void add_positions(const Elements& source, const Eigen::Affine3d& transform) {
    if (source.component != TINYGLTF_COMPONENT_TYPE_FLOAT) {
      fail("positions are not stored as floats");
    }
    if (coordinates_.size() / 3 + source.count > kMostElements) {
      fail("the mesh is too large", "at most " + std::to_string(kMostElements) + " vertices");
    }
    for (std::size_t i = 0; i < source.count; ++i) {
      float xyz[3];
      std::memcpy(xyz, source.first + i * source.stride, sizeof xyz);
      const Eigen::Vector3d point = transform * Eigen::Vector3d(xyz[0], xyz[1], xyz[2]);
      if (!(point.cwiseAbs().maxCoeff() <= kLargestCoordinate) || !point.allFinite()) {
        fail("position " + std::to_string(i) + " is not a usable number");
      }
      coordinates_.insert(coordinates_.end(), {point.x(), point.y(), point.z()});
    }
  }

  template <typename IndexAt>
  void add_triangles(const MeshPart& part, std::size_t count, IndexAt index_at_place) {
    if (count % 3 != 0 || corners_.size() + count > 3 * kMostElements) {
      fail("the number of a mesh's corners is not usable", "a multiple of 3",
           std::to_string(count));
    }
    for (std::size_t i = 0; i < count; i += 3) {
      std::array<int, 3> triangle;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t index = index_at_place(i + corner);
        if (index >= static_cast<std::size_t>(part.vertex_count)) {
          fail_index("vertex", static_cast<long long>(index),
                     static_cast<std::size_t>(part.vertex_count));
        }
        triangle[corner] = part.first_vertex + static_cast<int>(index);
      }
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) {
        corners_.insert(corners_.end(), triangle.begin(), triangle.end());
      }
    }
  }

  static constexpr int kDeepest = 200;

  bool with_shapes_ = false;
  TriangleMesh result_;
  std::vector<SceneNode> nodes_;
  std::vector<SceneMesh> meshes_;
  std::vector<std::string> names_; // of shapes
  std::map<std::string, std::size_t, std::less<>> shape_index_;
  std::vector<std::vector<double>> offsets_; // of each shape, as far as its last part
  std::vector<double> coordinates_;
  std::vector<int> corners_;
  std::vector<int> visited_;
  int depth_ = 0;
};

} // namespace

TriangleMesh parse_glb(std::string_view bytes, std::string_view where) {
  return SceneReader(bytes, where).scene(false).face.neutral;
}

FaceScene parse_face_scene(std::string_view bytes, std::string_view where) {
  return SceneReader(bytes, where).scene(true);
}

} // namespace phonomime
