// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/glb.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include <fmt/format.h>
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace phonomime {

namespace {

constexpr double kMetresPerMillimetre = 1e-3;

using FloatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

// A PCA dimension that moves: its morph target is scaled so that weights stay within [-1, 1].
struct ActiveTarget {
  Eigen::Index dimension = 0;
  double scale = 1.0;
};

std::vector<ActiveTarget> active_targets(const CoefficientMotion& motion) {
  std::vector<ActiveTarget> targets;
  for (Eigen::Index d = 0; d < motion.coefficients.cols(); ++d) {
    const double largest = motion.coefficients.col(d).cwiseAbs().maxCoeff();
    if (largest > 0.0) {
      targets.push_back({d, largest});
    }
  }
  return targets;
}

bool rests(const std::vector<HeadPose>& head) {
  return std::ranges::all_of(head, [&](const HeadPose& pose) {
    return pose.translation_mm == head.front().translation_mm &&
           pose.rotation.coeffs() == head.front().rotation.coeffs();
  });
}

// Appends to the model's one buffer and describes what was appended.
class GlbBuilder {
public:
  GlbBuilder() { model_.buffers.emplace_back(); }

  tinygltf::Model& model() { return model_; }

  int add_vectors(const FloatPoints& values, bool with_range) {
    const int accessor = add_accessor(values.data(), static_cast<std::size_t>(values.size()) * 4,
                                      values.rows(), TINYGLTF_TYPE_VEC3,
                                      TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
    if (with_range) {
      for (int axis = 0; axis < 3; ++axis) {
        model_.accessors.back().minValues.push_back(values.col(axis).minCoeff());
        model_.accessors.back().maxValues.push_back(values.col(axis).maxCoeff());
      }
    }
    return accessor;
  }

  int add_indices(const std::vector<std::uint32_t>& indices) {
    return add_accessor(indices.data(), indices.size() * 4,
                        static_cast<Eigen::Index>(indices.size()), TINYGLTF_TYPE_SCALAR,
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  }

  // Animation data: `components` of TINYGLTF_TYPE_*.
  int add_samples(const std::vector<float>& values, int components, bool with_range) {
    const auto width = static_cast<std::size_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(components)));
    const int accessor = add_accessor(values.data(), values.size() * 4,
                                      static_cast<Eigen::Index>(values.size() / width), components,
                                      TINYGLTF_COMPONENT_TYPE_FLOAT, 0);
    if (with_range) {
      const auto [low, high] = std::ranges::minmax(values);
      model_.accessors.back().minValues.push_back(low);
      model_.accessors.back().maxValues.push_back(high);
    }
    return accessor;
  }

private:
  int add_accessor(const void* data, std::size_t bytes, Eigen::Index count, int type,
                   int component_type, int target) {
    std::vector<unsigned char>& buffer = model_.buffers.front().data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = bytes;
    view.target = target;
    buffer.resize(buffer.size() + bytes); // everything here is a multiple of four bytes
    std::memcpy(buffer.data() + view.byteOffset, data, bytes);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.count = static_cast<std::size_t>(count);
    accessor.type = type;
    accessor.componentType = component_type;
    model_.bufferViews.push_back(std::move(view));
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  tinygltf::Model model_;
};

tinygltf::Material gltf_material(const MeshMaterial& material) {
  tinygltf::Material result;
  result.name = material.name;
  result.doubleSided = material.double_sided;
  result.pbrMetallicRoughness.baseColorFactor = {material.base_color.begin(),
                                                 material.base_color.end()};
  result.pbrMetallicRoughness.metallicFactor = material.metallic;
  result.pbrMetallicRoughness.roughnessFactor = material.roughness;
  return result;
}

// For a face that comes without a material.
MeshMaterial plain_skin() {
  return {.name = "skin",
          .base_color = {0.62, 0.40, 0.31, 1.0},
          .metallic = 0.0,
          .roughness = 0.55,
          .double_sided = true};
}

FloatPoints part_rows(const Points& points, const MeshPart& part, double scale) {
  return (scale * points.middleRows(part.first_vertex, part.vertex_count)).cast<float>();
}

std::vector<std::uint32_t> part_indices(const TriangleMesh& mesh, const MeshPart& part) {
  std::vector<std::uint32_t> indices;
  for (int t = 0; t < part.triangle_count; ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      indices.push_back(static_cast<std::uint32_t>(mesh.triangles(part.first_triangle + t, corner) -
                                                   part.first_vertex));
    }
  }
  return indices;
}

void add_mesh(GlbBuilder& builder, const TriangleMesh& mesh, const MorphTargets& morphs,
              const std::vector<ActiveTarget>& targets) {
  tinygltf::Model& model = builder.model();
  for (const MeshMaterial& material : mesh.materials) {
    model.materials.push_back(gltf_material(material));
  }
  const bool needs_skin =
      std::ranges::any_of(mesh.parts, [](const MeshPart& part) { return part.material < 0; });
  const int plain = static_cast<int>(model.materials.size());
  if (needs_skin) {
    model.materials.push_back(gltf_material(plain_skin()));
  }
  const Points normals = vertex_normals(morphs.base, mesh.triangles);
  std::vector<Points> offsets;
  std::vector<Points> normal_offsets;
  for (const ActiveTarget& target : targets) {
    offsets.push_back(target.scale * morphs.morphs[static_cast<std::size_t>(target.dimension)]);
    normal_offsets.push_back(vertex_normals(morphs.base + offsets.back(), mesh.triangles) -
                             normals);
  }
  tinygltf::Mesh face;
  face.name = "face";
  for (const MeshPart& part : mesh.parts) {
    if (part.triangle_count == 0) {
      continue;
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = part.material < 0 ? plain : part.material;
    primitive.indices = builder.add_indices(part_indices(mesh, part));
    primitive.attributes["POSITION"] =
        builder.add_vectors(part_rows(morphs.base, part, kMetresPerMillimetre), true);
    primitive.attributes["NORMAL"] = builder.add_vectors(part_rows(normals, part, 1.0), false);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      primitive.targets.push_back(
          {{"POSITION",
            builder.add_vectors(part_rows(offsets[k], part, kMetresPerMillimetre), true)},
           {"NORMAL", builder.add_vectors(part_rows(normal_offsets[k], part, 1.0), false)}});
    }
    face.primitives.push_back(std::move(primitive));
  }
  tinygltf::Value::Array names;
  for (const ActiveTarget& target : targets) {
    names.emplace_back(fmt::format("pca_{:02}", target.dimension));
  }
  if (!names.empty()) {
    face.extras = tinygltf::Value(tinygltf::Value::Object{{"targetNames", tinygltf::Value(names)}});
  }
  model.meshes.push_back(std::move(face));
}

std::vector<float> weight_samples(const CoefficientMotion& motion,
                                  const std::vector<ActiveTarget>& targets) {
  std::vector<float> samples;
  for (Eigen::Index frame = 0; frame < motion.coefficients.rows(); ++frame) {
    for (const ActiveTarget& target : targets) {
      samples.push_back(
          static_cast<float>(motion.coefficients(frame, target.dimension) / target.scale));
    }
  }
  return samples;
}

void add_channel(tinygltf::Animation& animation, int node, const char* path, int times,
                 int samples) {
  tinygltf::AnimationSampler sampler;
  sampler.input = times;
  sampler.output = samples;
  sampler.interpolation = "LINEAR";
  tinygltf::AnimationChannel channel;
  channel.sampler = static_cast<int>(animation.samplers.size());
  channel.target_node = node;
  channel.target_path = path;
  animation.samplers.push_back(std::move(sampler));
  animation.channels.push_back(std::move(channel));
}

void add_animation(GlbBuilder& builder, const CoefficientMotion& motion,
                   const std::vector<ActiveTarget>& targets, int head_node, int face_node) {
  const bool head_moves = !motion.head.empty() && !rests(motion.head);
  if (targets.empty() && !head_moves) {
    return;
  }
  std::vector<float> times;
  for (Eigen::Index frame = 0; frame < motion.coefficients.rows(); ++frame) {
    times.push_back(static_cast<float>(static_cast<double>(frame) / motion.rate_hz));
  }
  tinygltf::Animation animation;
  animation.name = "speech";
  const int time_accessor = builder.add_samples(times, TINYGLTF_TYPE_SCALAR, true);
  if (!targets.empty()) {
    add_channel(animation, face_node, "weights", time_accessor,
                builder.add_samples(weight_samples(motion, targets), TINYGLTF_TYPE_SCALAR, false));
  }
  if (head_moves) {
    std::vector<float> rotations;
    std::vector<float> translations;
    for (const HeadPose& pose : motion.head) {
      const Eigen::Quaterniond rotation = pose.rotation.normalized(); // outlives the loop over it
      for (const double value : rotation.coeffs()) {                  // x, y, z, w, as glTF
        rotations.push_back(static_cast<float>(value));
      }
      for (const double value : pose.translation_mm) {
        translations.push_back(static_cast<float>(kMetresPerMillimetre * value));
      }
    }
    add_channel(animation, head_node, "rotation", time_accessor,
                builder.add_samples(rotations, TINYGLTF_TYPE_VEC4, false));
    add_channel(animation, head_node, "translation", time_accessor,
                builder.add_samples(translations, TINYGLTF_TYPE_VEC3, false));
  }
  builder.model().animations.push_back(std::move(animation));
}

void add_nodes(tinygltf::Model& model, const CoefficientMotion& motion,
               const std::vector<ActiveTarget>& targets) {
  tinygltf::Node head;
  head.name = "head";
  head.children = {1};
  if (!motion.head.empty()) {
    const Eigen::Vector4d rotation = motion.head.front().rotation.normalized().coeffs();
    const Eigen::Vector3d translation = kMetresPerMillimetre * motion.head.front().translation_mm;
    head.rotation = {rotation.begin(), rotation.end()};
    head.translation = {translation.begin(), translation.end()};
  }
  tinygltf::Node face;
  face.name = "face";
  face.mesh = 0;
  for (const ActiveTarget& target : targets) { // a program without animations shows frame 0
    face.weights.push_back(motion.coefficients(0, target.dimension) / target.scale);
  }
  model.nodes = {std::move(head), std::move(face)};
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes.push_back(std::move(scene));
  model.defaultScene = 0;
}

void add_asset(tinygltf::Model& model, const GlbNotes& notes) {
  model.asset.version = "2.0";
  model.asset.generator = "Phonomime";
  tinygltf::Value::Array credits;
  for (const std::string& credit : notes.credits) {
    credits.emplace_back(credit);
  }
  model.asset.extras =
      tinygltf::Value(tinygltf::Value::Object{{"title", tinygltf::Value(notes.title)},
                                              {"credits", tinygltf::Value(std::move(credits))},
                                              {"synthetic", tinygltf::Value(notes.synthetic)}});
}

} // namespace

std::string marker_face_glb(const TriangleMesh& mesh, const MorphTargets& morphs,
                            const CoefficientMotion& motion, const GlbNotes& notes) {
  if (motion.coefficients.rows() == 0 ||
      motion.coefficients.cols() != static_cast<Eigen::Index>(morphs.morphs.size()) ||
      morphs.base.rows() != mesh.positions.rows()) {
    throw InternalError({.what = "mesh, morph targets and motion do not fit each other"});
  }
  const std::vector<ActiveTarget> targets = active_targets(motion);
  GlbBuilder builder;
  add_mesh(builder, mesh, morphs, targets);
  add_nodes(builder.model(), motion, targets);
  add_animation(builder, motion, targets, 0, 1);
  add_asset(builder.model(), notes);
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&builder.model(), stream, false, true)) {
    throw InternalError({.what = "the binary glTF could not be put together"});
  }
  return std::move(stream).str();
}

} // namespace phonomime
