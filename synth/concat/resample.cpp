// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/resample.h"

#include "db/types/errors.h"
#include "db/types/frame_times.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace phonomime {
namespace {

void check(const CoefficientMotion& motion, double fps, double end_s) {
  const auto frames = motion.coefficients.rows();
  if (frames == 0 || !(motion.rate_hz > 0.0) || !std::isfinite(motion.rate_hz)) {
    throw InternalError({.what = "a motion to resample has no frames or no rate"});
  }
  if (!(fps > 0.0) || !std::isfinite(fps) || !(end_s >= 0.0) || !std::isfinite(end_s)) {
    throw InternalError({.what = "a motion cannot be resampled so",
                         .expected = "a positive rate and an end that is not negative",
                         .got = std::to_string(fps) + " Hz up to " + std::to_string(end_s) + " s"});
  }
  if (!motion.head.empty() && motion.head.size() != static_cast<std::size_t>(frames)) {
    throw InternalError({.what = "head poses do not match the frames",
                         .expected = std::to_string(frames),
                         .got = std::to_string(motion.head.size())});
  }
}

// Column-wise change of rate. `source`: n by anything, n >= 1.
FrameMatrixD resample_columns(const FrameMatrixD& source, double rate_hz, double fps,
                              Eigen::Index count) {
  std::vector<double> positions;
  for (Eigen::Index k = 0; k < count; ++k) {
    positions.push_back(
        std::min(static_cast<double>(k) * rate_hz / fps, static_cast<double>(source.rows() - 1)));
  }
  return low_pass(source, positions, LowPassKernel(rate_hz, fps, kOutputLowPass));
}

FrameMatrixD copy_frames(const FrameMatrixD& source, Eigen::Index count) {
  FrameMatrixD result(count, source.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    result.row(k) = source.row(std::min(k, source.rows() - 1));
  }
  return result;
}

// Translation and quaternion side by side, each quaternion on the side of the one before: n by 7.
FrameMatrixD head_columns(const std::vector<HeadPose>& head) {
  FrameMatrixD columns(static_cast<Eigen::Index>(head.size()), 7);
  for (Eigen::Index k = 0; k < columns.rows(); ++k) {
    const HeadPose& pose = head[static_cast<std::size_t>(k)];
    Eigen::RowVector4d rotation = pose.rotation.coeffs().transpose();
    if (k > 0 && rotation.dot(columns.row(k - 1).tail<4>()) < 0.0) {
      rotation = -rotation;
    }
    columns.row(k) << pose.translation_mm.transpose(), rotation;
  }
  return columns;
}

std::vector<HeadPose> head_poses(const FrameMatrixD& columns) {
  std::vector<HeadPose> head(static_cast<std::size_t>(columns.rows()));
  for (Eigen::Index k = 0; k < columns.rows(); ++k) {
    HeadPose& pose = head[static_cast<std::size_t>(k)];
    pose.translation_mm = columns.row(k).head<3>().transpose();
    pose.rotation.coeffs() = columns.row(k).tail<4>().transpose();
    pose.rotation.normalize();
  }
  return head;
}

} // namespace

CoefficientMotion resample_motion(const CoefficientMotion& motion, double fps, double end_s) {
  check(motion, fps, end_s);
  const auto count = static_cast<Eigen::Index>(frame_count_to(end_s, fps));
  CoefficientMotion result;
  result.rate_hz = fps;
  if (fps == motion.rate_hz) {
    result.coefficients = copy_frames(motion.coefficients, count);
    for (Eigen::Index k = 0; !motion.head.empty() && k < count; ++k) {
      const auto frame = std::min(static_cast<std::size_t>(k), motion.head.size() - 1);
      result.head.push_back(motion.head[frame]);
    }
    return result;
  }
  result.coefficients = resample_columns(motion.coefficients, motion.rate_hz, fps, count);
  if (!motion.head.empty()) {
    result.head =
        head_poses(resample_columns(head_columns(motion.head), motion.rate_hz, fps, count));
  }
  return result;
}

} // namespace phonomime
