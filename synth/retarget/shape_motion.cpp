// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/shape_motion.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/retarget/shape_names.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {
namespace {

constexpr float kNoWeight = 1e-3F;
constexpr double kMillimetresPerMetre = 1000.0;

std::string shape_remedy(const std::string& name, const std::vector<std::string>& shapes) {
  const std::string meant = did_you_mean(name, shapes);
  return (meant.empty() ? "" : meant + " ") + "`--skip-missing` leaves such weights out.";
}

} // namespace

WeightsForFace weights_for_face(const MotionClip& clip, const std::vector<std::string>& shapes,
                                bool skip_missing, std::string_view where) {
  WeightsForFace result;
  result.weights.rate_hz = clip.rate_hz;
  result.weights.start_s = clip.start_s;
  result.weights.groups = shapes;
  result.weights.channels_per_group = 1;
  result.weights.frames =
      FrameMatrix::Zero(clip.frames.rows(), static_cast<Eigen::Index>(shapes.size()));
  std::vector<int> sources(shapes.size(), 0);
  for (std::size_t g = 0; g < clip.groups.size(); ++g) {
    const auto column = clip.frames.col(static_cast<Eigen::Index>(g));
    const std::vector<std::size_t> targets = matching_shapes(clip.groups[g], shapes);
    for (const std::size_t target : targets) {
      result.weights.frames.col(static_cast<Eigen::Index>(target)) += column;
      ++sources[target];
    }
    if (targets.empty()) {
      if (!skip_missing && !(column.size() == 0 || column.cwiseAbs().maxCoeff() < kNoWeight)) {
        throw InputError({.where = std::string(where),
                          .what = "the face has no shape " + quoted(clip.groups[g]),
                          .got = fmt::format("weights up to {:.3g}", column.cwiseAbs().maxCoeff()),
                          .remedy = shape_remedy(clip.groups[g], shapes)});
      }
      result.left_out.push_back(clip.groups[g]);
    }
  }
  if (result.left_out.size() == clip.groups.size()) {
    throw InputError({.where = std::string(where),
                      .what = "none of these weights has the name of a shape of the face",
                      .expected = fmt::format("names as {}", fmt::join(shapes, ", ")),
                      .got = clip.groups.empty() ? "none" : quoted(clip.groups.front())});
  }
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    if (sources[s] > 1) {
      result.weights.frames.col(static_cast<Eigen::Index>(s)) /= static_cast<float>(sources[s]);
    }
  }
  return result;
}

Similarity free_placement(const ShapeFace& face) {
  Eigen::RowVector3d least = Eigen::RowVector3d::Constant(HUGE_VAL);
  Eigen::RowVector3d most = -least;
  for (const Points& offsets : face.offsets) {
    for (Eigen::Index v = 0; v < offsets.rows(); ++v) {
      if (!offsets.row(v).isZero(0.0)) {
        least = least.cwiseMin(face.neutral.positions.row(v));
        most = most.cwiseMax(face.neutral.positions.row(v));
      }
    }
  }
  Similarity placement;
  placement.scale = kMillimetresPerMetre;
  if (least.allFinite()) {
    placement.translation = -placement.scale * 0.5 * (least + most).transpose();
  }
  return placement;
}

FacePose pose_on_face(const HeadPose& head, const Similarity& placement) {
  const Eigen::Matrix3d turned =
      placement.rotation.transpose() * head.rotation.toRotationMatrix() * placement.rotation;
  return {.rotation = Eigen::Quaterniond(turned).normalized(),
          .translation = placement.rotation.transpose() *
                         (head.rotation * placement.translation + head.translation_mm -
                          placement.translation) /
                         placement.scale};
}

HeadAngles head_angles(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d r = rotation.normalized().toRotationMatrix();
  return {.yaw = std::atan2(r(0, 2), r(2, 2)),
          .pitch = std::asin(std::clamp(-r(1, 2), -1.0, 1.0)),
          .roll = std::atan2(r(1, 0), r(1, 1))};
}

Eigen::Quaterniond head_rotation(const HeadAngles& angles) {
  return Eigen::AngleAxisd(angles.yaw, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.pitch, Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(angles.roll, Eigen::Vector3d::UnitZ());
}

} // namespace phonomime
