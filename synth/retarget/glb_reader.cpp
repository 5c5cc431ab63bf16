// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mesh_reader.h"

#include "db/types/errors.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/Geometry>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace phonomime {
namespace {

constexpr std::size_t kMostElements = 20'000'000;
constexpr double kLargestCoordinate = 1e9;
constexpr int kTriangles = 4; // glTF's default mode

// Pictures are not looked at, so none is decoded.
bool pass_over_image(tinygltf::Image*, const int, std::string*, std::string*, int, int,
                     const unsigned char*, int, void*) {
  return true;
}

class GlbParser {
public:
  GlbParser(std::string_view bytes, std::string_view where) : where_(where) {
    if (bytes.size() < 20 || bytes.substr(0, 4) != "glTF" ||
        bytes.size() > std::numeric_limits<unsigned>::max()) {
      fail("this is not a binary glTF file", "the bytes `glTF` at its start");
    }
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(pass_over_image, nullptr);
    std::string error;
    std::string warning;
    bool loaded = false;
    try {
      loaded = loader.LoadBinaryFromMemory(&model_, &error, &warning,
                                           reinterpret_cast<const unsigned char*>(bytes.data()),
                                           static_cast<unsigned>(bytes.size()));
    } catch (const std::exception& defect) {
      error = defect.what();
    }
    if (!loaded) {
      while (!error.empty() && (error.back() == '\n' || error.back() == '.')) {
        error.pop_back();
      }
      fail("this binary glTF file is damaged", {}, error);
    }
    if (!model_.extensionsRequired.empty()) {
      fail("the file needs an extension of glTF that Phonomime does not read", "plain glTF 2.0",
           model_.extensionsRequired.front());
    }
  }

  TriangleMesh mesh() {
    result_.source = where_;
    for (const tinygltf::Material& material : model_.materials) {
      result_.materials.push_back(material_of(material));
    }
    if (model_.scenes.empty()) {
      fail("there is no scene in this file", "a scene with the face");
    }
    const std::size_t scene =
        model_.defaultScene < 0 ? 0 : static_cast<std::size_t>(model_.defaultScene);
    if (scene >= model_.scenes.size()) {
      fail_index("scene", model_.defaultScene, model_.scenes.size());
    }
    visited_.assign(model_.nodes.size(), 0);
    for (const int node : model_.scenes[scene].nodes) {
      add_node(node, Eigen::Affine3d::Identity());
    }
    if (result_.parts.empty()) {
      fail("there is no mesh in this file's scene", "a face of triangles");
    }
    result_.positions = Eigen::Map<const Points>(
        coordinates_.data(), static_cast<Eigen::Index>(coordinates_.size() / 3), 3);
    result_.triangles = Eigen::Map<const Triangles>(
        corners_.data(), static_cast<Eigen::Index>(corners_.size() / 3), 3);
    return std::move(result_);
  }

private:
  [[noreturn]] void fail(std::string what, std::string expected = {}, std::string got = {}) const {
    throw InputError({.where = where_,
                      .what = std::move(what),
                      .expected = std::move(expected),
                      .got = std::move(got)});
  }

  [[noreturn]] void fail_index(std::string_view kind, long long index, std::size_t count) const {
    fail("a reference to a " + std::string(kind) + " leads nowhere",
         "less than " + std::to_string(count), std::to_string(index));
  }

  template <typename T>
  const T& at(const std::vector<T>& items, int index, std::string_view kind) const {
    if (index < 0 || static_cast<std::size_t>(index) >= items.size()) {
      fail_index(kind, index, items.size());
    }
    return items[static_cast<std::size_t>(index)];
  }

  static MeshMaterial material_of(const tinygltf::Material& source) {
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

  void add_node(int index, const Eigen::Affine3d& parent) {
    const tinygltf::Node& node = at(model_.nodes, index, "node");
    if (visited_[static_cast<std::size_t>(index)]++ != 0) {
      fail("the scene's nodes are not a tree", "each node once",
           "node " + std::to_string(index) + " again");
    }
    const Eigen::Affine3d transform = parent * transform_of(node);
    if (node.mesh >= 0) {
      for (const tinygltf::Primitive& primitive : at(model_.meshes, node.mesh, "mesh").primitives) {
        add_primitive(primitive, transform);
      }
    }
    if (++depth_ > kDeepest) {
      fail("the scene's nodes are nested too deeply",
           "at most " + std::to_string(kDeepest) + " levels");
    }
    for (const int child : node.children) {
      add_node(child, transform);
    }
    --depth_;
  }

  // First byte of each element and the distance between elements, all checked to lie inside.
  struct Elements {
    const unsigned char* first = nullptr;
    std::size_t stride = 0;
    std::size_t count = 0;
    int component = 0;
  };

  Elements elements(int accessor_index, int type, std::string_view what) const {
    const tinygltf::Accessor& accessor = at(model_.accessors, accessor_index, "accessor");
    if (accessor.sparse.isSparse || accessor.bufferView < 0) {
      fail(std::string(what) + " are stored sparsely, which Phonomime does not read");
    }
    if (accessor.type != type) {
      fail(std::string(what) + " have another type than glTF asks for");
    }
    const tinygltf::BufferView& view = at(model_.bufferViews, accessor.bufferView, "buffer view");
    const tinygltf::Buffer& buffer = at(model_.buffers, view.buffer, "buffer");
    const int stride = accessor.ByteStride(view);
    if (stride <= 0 || accessor.count == 0 || accessor.count > kMostElements) {
      fail("the number or the layout of the " + std::string(what) + " is not usable",
           "1 to " + std::to_string(kMostElements), std::to_string(accessor.count));
    }
    const std::size_t size = static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)) *
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    const std::size_t bytes = buffer.data.size();
    const std::size_t span = static_cast<std::size_t>(stride) * (accessor.count - 1) + size;
    if (view.byteOffset > bytes || accessor.byteOffset > bytes - view.byteOffset ||
        span > bytes - view.byteOffset - accessor.byteOffset) {
      fail("the " + std::string(what) + " reach past the end of the file's data",
           "at most " + std::to_string(bytes) + " bytes");
    }
    return {buffer.data.data() + view.byteOffset + accessor.byteOffset,
            static_cast<std::size_t>(stride), accessor.count, accessor.componentType};
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
      at(model_.materials, primitive.material, "material");
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

  std::size_t index_at(const Elements& source, std::size_t i) const {
    const unsigned char* from = source.first + i * source.stride;
    if (source.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) {
      return *from;
    }
    if (source.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
      std::uint16_t value = 0;
      std::memcpy(&value, from, sizeof value);
      return value;
    }
    if (source.component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
      fail("indices are not stored as unsigned integers");
    }
    std::uint32_t value = 0;
    std::memcpy(&value, from, sizeof value);
    return value;
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

  std::string where_;
  tinygltf::Model model_;
  TriangleMesh result_;
  std::vector<double> coordinates_;
  std::vector<int> corners_;
  std::vector<int> visited_;
  int depth_ = 0;
};

} // namespace

TriangleMesh parse_glb(std::string_view bytes, std::string_view where) {
  return GlbParser(bytes, where).mesh();
}

} // namespace phonomime
