// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/shape_files.h"

#include "db/types/live_link_columns.h"
#include "synth/export/motion_csv.h"
#include "synth/retarget/shape_names.h"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kCentimetresPerMillimetre = 0.1;
constexpr int kHeadYaw = static_cast<int>(kArkitShapeCount);
constexpr int kFirstEyeAngle = kHeadYaw + 3;

Layout weight_layout(const std::vector<std::string>& names) {
  Layout layout;
  layout.kind = LayoutKind::weights;
  for (const std::string& name : names) {
    layout.groups.push_back({.name = name, .regions = {}});
  }
  return layout;
}

// E11 that changes nothing.
PcaModel plain_model(Eigen::Index channels) {
  PcaModel model;
  model.mean = Eigen::VectorXd::Zero(channels);
  model.basis = Eigen::MatrixXd::Identity(channels, channels);
  model.variance = Eigen::VectorXd::Ones(channels);
  return model;
}

} // namespace

std::string shape_weight_csv(const ShapeMotion& motion) {
  return weight_csv(weight_layout(motion.weights.groups), plain_model(motion.weights.frames.cols()),
                    {.rate_hz = motion.weights.rate_hz,
                     .coefficients = motion.weights.frames.cast<double>(),
                     .head = {}});
}

std::string shape_live_link_csv(const ShapeMotion& motion) {
  const auto columns = static_cast<Eigen::Index>(kLiveLinkColumns.size());
  FrameMatrixD values = FrameMatrixD::Zero(motion.weights.frames.rows(), columns);
  std::vector<int> sources(kArkitShapeCount, 0);
  for (std::size_t g = 0; g < motion.weights.groups.size(); ++g) {
    if (const std::optional<std::size_t> shape = arkit_shape(motion.weights.groups[g])) {
      values.col(static_cast<Eigen::Index>(*shape)) +=
          motion.weights.frames.col(static_cast<Eigen::Index>(g)).cast<double>();
      ++sources[*shape];
    }
  }
  for (std::size_t shape = 0; shape < kArkitShapeCount; ++shape) {
    values.col(static_cast<Eigen::Index>(shape)) /= std::max(1, sources[shape]);
  }
  for (std::size_t frame = 0; frame < motion.head.size(); ++frame) {
    const HeadAngles angles = head_angles(motion.head[frame].rotation);
    values.row(static_cast<Eigen::Index>(frame)).segment<3>(kHeadYaw) << angles.yaw, -angles.pitch,
        -angles.roll;
  }
  if (motion.eyes.rows() > 0) {
    values.rightCols(columns - kFirstEyeAngle) = motion.eyes.cast<double>();
  }
  const std::vector<std::string> names(kLiveLinkColumns.begin(), kLiveLinkColumns.end());
  return live_link_csv(
      weight_layout(names), plain_model(columns),
      {.rate_hz = motion.weights.rate_hz, .coefficients = std::move(values), .head = {}});
}

std::string head_bvh(const ShapeMotion& motion) {
  const Eigen::Index frames = motion.weights.frames.rows();
  std::string text = fmt::format("HIERARCHY\n"
                                 "ROOT head\n"
                                 "{{\n"
                                 "  OFFSET 0.0 0.0 0.0\n"
                                 "  CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation "
                                 "Zrotation\n"
                                 "  End Site\n"
                                 "  {{\n"
                                 "    OFFSET 0.0 10.0 0.0\n"
                                 "  }}\n"
                                 "}}\n"
                                 "MOTION\n"
                                 "Frames: {}\n"
                                 "Frame Time: {:.9f}\n",
                                 frames, 1.0 / motion.weights.rate_hz);
  for (Eigen::Index frame = 0; frame < frames; ++frame) {
    const HeadPose pose =
        motion.head.empty() ? HeadPose() : motion.head[static_cast<std::size_t>(frame)];
    const HeadAngles angles = head_angles(pose.rotation);
    const Eigen::Vector3d place = kCentimetresPerMillimetre * pose.translation_mm;
    fmt::format_to(std::back_inserter(text), "{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n",
                   place.x(), place.y(), place.z(), kDegrees * angles.yaw, kDegrees * angles.pitch,
                   kDegrees * angles.roll);
  }
  return text;
}

} // namespace phonomime
