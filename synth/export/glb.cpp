// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/glb.h"

#include "db/types/errors.h"
#include "synth/export/gltf_builder.h"

#include <cmath>

namespace phonomime {
namespace {

constexpr double kMetresPerMm = 1e-3;
constexpr double kLeastCoefficient = 1e-9; // mm; smaller all along = not used
constexpr double kNormalStep = 0.1;        // of a morph's full weight

MeshMaterial skin_material() {
  return {.name = "skin",
          .base_color = {0.72, 0.45, 0.35, 1.0},
          .metallic = 0.0,
          .roughness = 0.6,
          .double_sided = true};
}

// A PCA dimension that the motion uses.
struct UsedMorph {
  Eigen::Index dimension = 0;
  double scale = 1.0; // weight 1 = this coefficient
};

std::vector<UsedMorph> used_morphs(const CoefficientMotion& motion) {
  std::vector<UsedMorph> used;
  for (Eigen::Index d = 0; d < motion.coefficients.cols(); ++d) {
    const double largest = motion.coefficients.col(d).cwiseAbs().maxCoeff();
    if (largest > kLeastCoefficient) {
      used.push_back({d, largest});
    }
  }
  return used;
}

class GlbMaker {
public:
  GlbMaker(const TriangleMesh& mesh, const MorphTargets& targets, const CoefficientMotion& motion,
           const ExportNotes& notes)
      : mesh_(mesh), targets_(targets), motion_(motion), used_(used_morphs(motion)),
        builder_(notes.title, notes.credits, notes.synthetic) {}

  std::string make() {
    add_materials();
    find_normals();
    std::vector<GltfBuilder::Primitive> moving;
    std::vector<GltfBuilder::Primitive> resting;
    for (std::size_t p = 0; p < mesh_.parts.size(); ++p) {
      const MeshPart& part = mesh_.parts[p];
      if (part.triangle_count == 0 && p > 0) {
        continue;
      }
      const bool moves = p == 0 || moves_at_all(part);
      (moves ? moving : resting).push_back(primitive_of(part, moves));
    }
    std::vector<double> first_weights;
    std::vector<std::string> names;
    for (const UsedMorph& morph : used_) {
      first_weights.push_back(motion_.coefficients(0, morph.dimension) / morph.scale);
      names.push_back("pca" + std::to_string(morph.dimension));
    }
    const int head =
        builder_.add_node("head", builder_.add_mesh("face", moving, first_weights, names));
    if (!resting.empty()) {
      builder_.add_node("head_parts", builder_.add_mesh("parts", resting, {}, {}), head);
    }
    animate(head);
    return builder_.finish();
  }

private:
  void add_materials() {
    for (const MeshMaterial& material : mesh_.materials) {
      builder_.add_material(material);
    }
    default_material_ = -1;
    for (const MeshPart& part : mesh_.parts) {
      if (part.material < 0 && default_material_ < 0) {
        default_material_ = builder_.add_material(skin_material());
      }
    }
  }

  void find_normals() {
    normals_ = vertex_normals(targets_.base, mesh_.triangles);
    for (const UsedMorph& morph : used_) {
      const Points step =
          kNormalStep * morph.scale * targets_.morphs[static_cast<std::size_t>(morph.dimension)];
      normal_deltas_.push_back((vertex_normals(targets_.base + step, mesh_.triangles) -
                                vertex_normals(targets_.base - step, mesh_.triangles)) /
                               (2.0 * kNormalStep));
    }
  }

  bool moves_at_all(const MeshPart& part) const {
    for (const UsedMorph& morph : used_) {
      const Points& delta = targets_.morphs[static_cast<std::size_t>(morph.dimension)];
      if (!delta.middleRows(part.first_vertex, part.vertex_count).isZero(0.0)) {
        return true;
      }
    }
    return false;
  }

  GltfBuilder::Primitive primitive_of(const MeshPart& part, bool moves) {
    const auto rows = [&](const Points& all) -> Points {
      return all.middleRows(part.first_vertex, part.vertex_count);
    };
    GltfBuilder::Primitive primitive;
    primitive.positions = builder_.add_vertices(kMetresPerMm * rows(targets_.base));
    primitive.normals = builder_.add_vertices(rows(normals_));
    std::vector<std::uint32_t> indices;
    indices.reserve(static_cast<std::size_t>(part.triangle_count) * 3);
    for (int t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        indices.push_back(
            static_cast<std::uint32_t>(mesh_.triangles(t, corner) - part.first_vertex));
      }
    }
    primitive.indices = builder_.add_indices(indices);
    primitive.material = part.material >= 0 ? part.material : default_material_;
    for (std::size_t m = 0; moves && m < used_.size(); ++m) {
      const Points& delta = targets_.morphs[static_cast<std::size_t>(used_[m].dimension)];
      primitive.targets.push_back(
          {builder_.add_vertices(kMetresPerMm * used_[m].scale * rows(delta)),
           builder_.add_vertices(rows(normal_deltas_[m]))});
    }
    return primitive;
  }

  void animate(int head) {
    const Eigen::Index frames = motion_.coefficients.rows();
    std::vector<float> times;
    std::vector<float> weights;
    for (Eigen::Index k = 0; k < frames; ++k) {
      times.push_back(static_cast<float>(static_cast<double>(k) / motion_.rate_hz));
      for (const UsedMorph& morph : used_) {
        weights.push_back(
            static_cast<float>(motion_.coefficients(k, morph.dimension) / morph.scale));
      }
    }
    const int keys = builder_.add_keys(times, 1);
    if (!used_.empty()) {
      builder_.animate(head, "weights", keys, builder_.add_keys(weights, 1));
    }
    if (motion_.head.empty()) {
      return;
    }
    std::vector<float> translations;
    std::vector<float> rotations;
    Eigen::Quaterniond before = motion_.head.front().rotation.normalized();
    builder_.place_node(head, kMetresPerMm * motion_.head.front().translation_mm, before);
    for (const HeadPose& pose : motion_.head) {
      const Eigen::Vector3f translation = (kMetresPerMm * pose.translation_mm).cast<float>();
      translations.insert(translations.end(), translation.data(), translation.data() + 3);
      Eigen::Quaterniond rotation = pose.rotation.normalized();
      if (rotation.dot(before) < 0.0) {
        rotation.coeffs() = -rotation.coeffs(); // the same pose, the short way from the last one
      }
      before = rotation;
      const Eigen::Quaternionf narrow = rotation.cast<float>().normalized();
      rotations.insert(rotations.end(), {narrow.x(), narrow.y(), narrow.z(), narrow.w()});
    }
    builder_.animate(head, "translation", keys, builder_.add_keys(translations, 3));
    builder_.animate(head, "rotation", keys, builder_.add_keys(rotations, 4));
  }

  const TriangleMesh& mesh_;
  const MorphTargets& targets_;
  const CoefficientMotion& motion_;
  std::vector<UsedMorph> used_;
  GltfBuilder builder_;
  int default_material_ = -1;
  Points normals_;
  std::vector<Points> normal_deltas_; // of the used morphs, at full weight
};

} // namespace

std::string make_glb(const TriangleMesh& mesh, const MorphTargets& targets,
                     const CoefficientMotion& motion, const ExportNotes& notes) {
  const auto frames = motion.coefficients.rows();
  if (targets.base.rows() != mesh.vertex_count() ||
      static_cast<Eigen::Index>(targets.morphs.size()) != motion.coefficients.cols() ||
      (!motion.head.empty() && static_cast<Eigen::Index>(motion.head.size()) != frames)) {
    throw InternalError({.what = "a face and its motion do not belong together"});
  }
  if (frames == 0 || !(motion.rate_hz > 0.0) || !motion.coefficients.allFinite()) {
    throw InputError(
        {.what = "there is no motion to animate the face with", .expected = "at least one frame"});
  }
  return GlbMaker(mesh, targets, motion, notes).make();
}

} // namespace phonomime
