// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/gltf_builder.h"

#include "db/types/errors.h"

#include <cstring>
#include <limits>
#include <sstream>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace phonomime {

struct GltfBuilder::Parts {
  tinygltf::Model model;
  std::vector<unsigned char> bytes;

  int add_view(const void* data, std::size_t size, int target) {
    bytes.resize((bytes.size() + 3) / 4 * 4, 0);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = size;
    view.target = target;
    const auto* first = static_cast<const unsigned char*>(data);
    bytes.insert(bytes.end(), first, first + size);
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size()) - 1;
  }

  int add_accessor(int view, int component, int type, std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size()) - 1;
  }
};

GltfBuilder::GltfBuilder(std::string title, const std::vector<std::string>& credits, bool synthetic)
    : parts_(std::make_unique<Parts>()) {
  tinygltf::Asset& asset = parts_->model.asset;
  asset.version = "2.0";
  asset.generator = "Phonomime";
  tinygltf::Value::Array names;
  for (const std::string& credit : credits) {
    asset.copyright += (asset.copyright.empty() ? "" : "; ") + credit;
    names.emplace_back(credit);
  }
  asset.extras =
      tinygltf::Value(tinygltf::Value::Object{{"title", tinygltf::Value(std::move(title))},
                                              {"credits", tinygltf::Value(std::move(names))},
                                              {"synthetic", tinygltf::Value(synthetic)}});
  parts_->model.scenes.emplace_back();
  parts_->model.defaultScene = 0;
}

GltfBuilder::~GltfBuilder() = default;

int GltfBuilder::add_vertices(const Points& values) {
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> floats = values.cast<float>();
  const int view =
      parts_->add_view(floats.data(), sizeof(float) * static_cast<std::size_t>(floats.size()),
                       TINYGLTF_TARGET_ARRAY_BUFFER);
  const int accessor = parts_->add_accessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                            static_cast<std::size_t>(floats.rows()));
  const Eigen::RowVector3d low = floats.colwise().minCoeff().cast<double>();
  const Eigen::RowVector3d high = floats.colwise().maxCoeff().cast<double>();
  auto& target = parts_->model.accessors.back();
  target.minValues.assign(low.data(), low.data() + 3);
  target.maxValues.assign(high.data(), high.data() + 3);
  return accessor;
}

int GltfBuilder::add_indices(std::span<const std::uint32_t> values) {
  std::uint32_t largest = 0;
  for (const std::uint32_t value : values) {
    largest = std::max(largest, value);
  }
  if (largest < std::numeric_limits<std::uint16_t>::max()) {
    const std::vector<std::uint16_t> narrow(values.begin(), values.end());
    const int view = parts_->add_view(narrow.data(), narrow.size() * sizeof(std::uint16_t),
                                      TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    return parts_->add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR,
                                values.size());
  }
  const int view =
      parts_->add_view(values.data(), values.size_bytes(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  return parts_->add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                              values.size());
}

int GltfBuilder::add_keys(std::span<const float> values, int width) {
  const int type = width == 1   ? TINYGLTF_TYPE_SCALAR
                   : width == 3 ? TINYGLTF_TYPE_VEC3
                                : TINYGLTF_TYPE_VEC4;
  const int view = parts_->add_view(values.data(), values.size_bytes(), 0);
  const int accessor = parts_->add_accessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, type,
                                            values.size() / static_cast<std::size_t>(width));
  if (width == 1 && !values.empty()) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    parts_->model.accessors.back().minValues = {static_cast<double>(*low)};
    parts_->model.accessors.back().maxValues = {static_cast<double>(*high)};
  }
  return accessor;
}

int GltfBuilder::add_material(const MeshMaterial& material) {
  tinygltf::Material added;
  added.name = material.name;
  added.doubleSided = material.double_sided;
  auto& surface = added.pbrMetallicRoughness;
  surface.baseColorFactor.assign(material.base_color.begin(), material.base_color.end());
  surface.metallicFactor = material.metallic;
  surface.roughnessFactor = material.roughness;
  parts_->model.materials.push_back(std::move(added));
  return static_cast<int>(parts_->model.materials.size()) - 1;
}

int GltfBuilder::add_mesh(std::string name, const std::vector<Primitive>& primitives,
                          const std::vector<double>& weights,
                          const std::vector<std::string>& target_names) {
  tinygltf::Mesh mesh;
  mesh.name = std::move(name);
  mesh.weights = weights;
  for (const Primitive& source : primitives) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes = {{"POSITION", source.positions}, {"NORMAL", source.normals}};
    primitive.indices = source.indices;
    primitive.material = source.material;
    for (const Primitive::Target& target : source.targets) {
      primitive.targets.push_back({{"POSITION", target.positions}, {"NORMAL", target.normals}});
    }
    mesh.primitives.push_back(std::move(primitive));
  }
  if (!target_names.empty()) {
    tinygltf::Value::Array names;
    for (const std::string& target : target_names) {
      names.emplace_back(target);
    }
    mesh.extras = tinygltf::Value(
        tinygltf::Value::Object{{"targetNames", tinygltf::Value(std::move(names))}});
  }
  parts_->model.meshes.push_back(std::move(mesh));
  return static_cast<int>(parts_->model.meshes.size()) - 1;
}

int GltfBuilder::add_node(std::string name, int mesh, int parent) {
  tinygltf::Node node;
  node.name = std::move(name);
  node.mesh = mesh;
  parts_->model.nodes.push_back(std::move(node));
  const int index = static_cast<int>(parts_->model.nodes.size()) - 1;
  auto& siblings = parent < 0 ? parts_->model.scenes.front().nodes
                              : parts_->model.nodes[static_cast<std::size_t>(parent)].children;
  siblings.push_back(index);
  return index;
}

void GltfBuilder::place_node(int node, const Eigen::Vector3d& translation,
                             const Eigen::Quaterniond& rotation) {
  auto& placed = parts_->model.nodes[static_cast<std::size_t>(node)];
  placed.translation = {translation.x(), translation.y(), translation.z()};
  placed.rotation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
}

void GltfBuilder::animate(int node, std::string path, int times, int values) {
  if (parts_->model.animations.empty()) {
    parts_->model.animations.emplace_back();
    parts_->model.animations.back().name = "speech";
  }
  tinygltf::Animation& animation = parts_->model.animations.back();
  tinygltf::AnimationSampler sampler;
  sampler.input = times;
  sampler.output = values;
  sampler.interpolation = "LINEAR";
  animation.samplers.push_back(std::move(sampler));
  tinygltf::AnimationChannel channel;
  channel.sampler = static_cast<int>(animation.samplers.size()) - 1;
  channel.target_node = node;
  channel.target_path = std::move(path);
  animation.channels.push_back(std::move(channel));
}

std::string GltfBuilder::finish() {
  parts_->bytes.resize((parts_->bytes.size() + 3) / 4 * 4, 0);
  if (parts_->bytes.size() > std::numeric_limits<std::uint32_t>::max() / 2) {
    throw InputError({.what = "the face is too large for one GLB file",
                      .expected = "less than 2 GiB",
                      .got = std::to_string(parts_->bytes.size()) + " bytes"});
  }
  tinygltf::Buffer buffer;
  buffer.data = std::move(parts_->bytes);
  parts_->model.buffers = {std::move(buffer)};
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&parts_->model, stream, false, true)) {
    throw InternalError({.what = "the GLB could not be put together"});
  }
  return std::move(stream).str();
}

} // namespace phonomime
