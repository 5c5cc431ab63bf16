// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/named_weights.h"

#include "db/import/gaps.h"
#include "db/import/resample.h"
#include "db/types/errors.h"
#include "db/types/live_link_columns.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::size_t kHeadAngles = 3;
constexpr std::size_t kEyeAngles = 6;

// #frames by the columns of these names, where the clip has all of them.
std::optional<FrameMatrix> columns_of(const MotionClip& clip, std::size_t first,
                                      std::size_t count) {
  FrameMatrix columns(clip.frames.rows(), static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto found = std::ranges::find(clip.groups, kLiveLinkColumns[first + i]);
    if (found == clip.groups.end()) {
      return std::nullopt;
    }
    columns.col(static_cast<Eigen::Index>(i)) = clip.frames.col(found - clip.groups.begin());
  }
  return columns;
}

// Weights without the angles of head and eyes.
MotionClip without_angles(const MotionClip& clip) {
  MotionClip weights = clip;
  weights.groups.clear();
  Eigen::Index kept = 0;
  for (std::size_t g = 0; g < clip.groups.size(); ++g) {
    if (std::find(kLiveLinkColumns.begin() + kArkitShapeCount, kLiveLinkColumns.end(),
                  clip.groups[g]) == kLiveLinkColumns.end()) {
      weights.groups.push_back(clip.groups[g]);
      weights.frames.col(kept++) = clip.frames.col(static_cast<Eigen::Index>(g));
    }
  }
  weights.frames.conservativeResize(Eigen::NoChange, kept);
  return weights;
}

// Finite everywhere, at the rate that is asked for.
MotionClip prepared(MotionClip clip, double rate_hz, const std::string& where,
                    std::vector<std::string>& notes) {
  if (clip.frames.rows() == 0) {
    throw InputError({.where = where, .what = "the motion has no frame"});
  }
  const std::vector<int> absent =
      groups_missing_throughout(clip.frames.cast<double>(), clip.channels_per_group);
  if (!absent.empty()) {
    throw InputError({.where = where,
                      .what = "no frame has a value of " +
                              quoted(clip.groups[static_cast<std::size_t>(absent.front())])});
  }
  const GapFill filled =
      fill_gaps(clip.frames.cast<double>(), clip.channels_per_group, clip.rate_hz, 0.1);
  const auto held = std::ranges::count(filled.frame_has_gap, 1);
  if (held > 0) {
    notes.push_back(fmt::format("{} frames without values are bridged", held));
  }
  if (rate_hz == 0.0 || rate_hz == clip.rate_hz) {
    clip.frames = filled.frames.cast<float>();
    return clip;
  }
  const double duration_s = static_cast<double>(clip.frames.rows() - 1) / clip.rate_hz;
  const auto count = static_cast<Eigen::Index>(std::floor(duration_s * rate_hz + 1e-6)) + 1;
  clip.frames = resample(filled.frames, {.rate_hz = clip.rate_hz, .start_s = 0.0}, rate_hz, count)
                    .cast<float>();
  clip.rate_hz = rate_hz;
  return clip;
}

// Live Link Face's signs: yaw to its own left, pitch up, roll to its own left are positive.
std::vector<HeadPose> live_link_head(const FrameMatrix& angles) {
  std::vector<HeadPose> head;
  if (angles.isZero(0.0F)) {
    return head;
  }
  for (Eigen::Index frame = 0; frame < angles.rows(); ++frame) {
    head.push_back(
        {.translation_mm = Eigen::Vector3d::Zero(),
         .rotation = head_rotation(
             {.yaw = angles(frame, 0), .pitch = -angles(frame, 1), .roll = -angles(frame, 2)})});
  }
  return head;
}

} // namespace

ShapeMotion motion_of_weights(const RetargetApplyOptions& options, const MotionClip& clip,
                              const ShapeFace& face, RetargetReport& report) {
  const std::string where = options.motion.string();
  const MotionClip whole = prepared(clip, options.fps, where, report.notes);
  WeightsForFace fitting =
      weights_for_face(without_angles(whole), face.names, options.skip_missing, where);
  report.left_out = std::move(fitting.left_out);
  ShapeMotion motion{.weights = std::move(fitting.weights),
                     .head = {},
                     .placement = free_placement(face),
                     .eyes = {}};
  if (const auto angles = columns_of(whole, kArkitShapeCount, kHeadAngles)) {
    motion.head = live_link_head(*angles);
  }
  if (auto angles = columns_of(whole, kArkitShapeCount + kHeadAngles, kEyeAngles)) {
    motion.eyes = std::move(*angles);
  }
  return motion;
}

} // namespace phonomime
