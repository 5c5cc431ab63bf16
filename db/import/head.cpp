// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/head.h"

#include "db/types/errors.h"

#include <Eigen/SVD>

#include <cmath>

#include <fmt/format.h>

namespace phonomime {

namespace {

struct SizedPose {
  HeadPose pose;
  double size = 1.0;
};

// The pose and size fitted to the groups of the anchor that the frame shows.
std::optional<SizedPose> pose_of_frame(const Eigen::VectorXd& frame, const HeadAnchor& anchor,
                                       const Eigen::VectorXd& reference_pose, Scale scale) {
  Eigen::Matrix3Xd reference(3, anchor.groups.size());
  Eigen::Matrix3Xd points(3, anchor.groups.size());
  Eigen::Index count = 0;
  for (const int group : anchor.groups) {
    const Eigen::Vector3d point = marker_of(frame, group);
    if (point.allFinite()) {
      reference.col(count) = marker_of(reference_pose, group);
      points.col(count) = point;
      ++count;
    }
  }
  if (anchor.gives_rotation) {
    const Eigen::Matrix3Xd shown = reference.leftCols(count);
    const double size = count == 0 || scale == Scale::measured
                            ? 1.0
                            : point_spread(points.leftCols(count)) / point_spread(shown);
    const std::optional<HeadPose> pose = fit_pose(size * shown, points.leftCols(count));
    return pose ? std::optional(SizedPose{*pose, size}) : std::nullopt;
  }
  if (count < static_cast<Eigen::Index>(anchor.groups.size())) {
    return std::nullopt;
  }
  SizedPose centred;
  centred.pose.translation_mm = points.rowwise().mean() - reference.rowwise().mean();
  return centred;
}

SizedPose between(const SizedPose& a, const SizedPose& b, double share) {
  return {.pose = {.translation_mm =
                       (1.0 - share) * a.pose.translation_mm + share * b.pose.translation_mm,
                   .rotation = a.pose.rotation.slerp(share, b.pose.rotation)},
          .size = (1.0 - share) * a.size + share * b.size};
}

// Fills the poses that `known` does not have. At least one is known.
Eigen::Index interpolate_unknown(std::vector<SizedPose>& head, const std::vector<bool>& known) {
  const std::size_t none = head.size();
  std::size_t last = none;
  Eigen::Index interpolated = 0;
  for (std::size_t k = 0; k < head.size(); ++k) {
    if (known[k]) {
      last = k;
      continue;
    }
    std::size_t next = k + 1;
    while (next < head.size() && !known[next]) {
      ++next;
    }
    for (std::size_t j = k; j < next; ++j) {
      if (last == none) {
        head[j] = head[next];
      } else if (next == head.size()) {
        head[j] = head[last];
      } else {
        head[j] = between(head[last], head[next],
                          static_cast<double>(j - last) / static_cast<double>(next - last));
      }
    }
    interpolated += static_cast<Eigen::Index>(next - k);
    k = next - 1;
  }
  return interpolated;
}

} // namespace

HeadAnchor head_anchor(const Layout& layout, std::string_view where) {
  HeadAnchor anchor{.groups = layout.groups_in(Region::rigid), .gives_rotation = true};
  if (anchor.groups.size() >= 3) {
    return anchor;
  }
  const std::optional<int> reference = layout.find_group(layout.reference);
  if (!reference) {
    throw InputError({.where = std::string(where),
                      .what = "layout does not say what the head pose is measured by",
                      .expected = "at least three rigid groups or a reference marker",
                      .got = fmt::format("{} rigid, no reference", anchor.groups.size()),
                      .remedy = "Name a `reference` marker in the layout."});
  }
  return {.groups = {*reference}, .gives_rotation = false};
}

std::optional<HeadPose> fit_pose(const Eigen::Matrix3Xd& reference,
                                 const Eigen::Matrix3Xd& points) {
  if (points.cols() < 3) {
    return std::nullopt;
  }
  const Eigen::Vector3d reference_centre = reference.rowwise().mean();
  const Eigen::Vector3d points_centre = points.rowwise().mean();
  const Eigen::Matrix3Xd y = reference.colwise() - reference_centre;
  const Eigen::Matrix3Xd x = points.colwise() - points_centre;
  const Eigen::Matrix3d product = y * x.transpose(); // E1, points in columns: y^T x = U D V^T
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  constexpr double kFlattest = 1e-6; // second singular value over the first: points on a line
  if (!(svd.singularValues()(1) > kFlattest * svd.singularValues()(0))) {
    return std::nullopt;
  }
  Eigen::Matrix3d rotation = svd.matrixV() * svd.matrixU().transpose(); // E2
  if (rotation.determinant() < 0.0) {
    Eigen::Matrix3d v = svd.matrixV();
    v.col(2) = -v.col(2);
    rotation = v * svd.matrixU().transpose();
  }
  HeadPose pose;
  pose.rotation = Eigen::Quaterniond(rotation).normalized();
  pose.translation_mm = points_centre - rotation * reference_centre;
  return pose;
}

double point_spread(const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d centre = points.rowwise().mean();
  return std::sqrt((points.colwise() - centre).colwise().squaredNorm().mean());
}

Eigen::VectorXd centred_on_anchor(const Eigen::VectorXd& pose, const HeadAnchor& anchor) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const int group : anchor.groups) {
    centre += marker_of(pose, group);
  }
  centre /= static_cast<double>(anchor.groups.size());
  return pose - centre.replicate(pose.size() / 3, 1);
}

bool anchor_is_whole(const Eigen::Ref<const Eigen::VectorXd>& frame, const HeadAnchor& anchor) {
  for (const int group : anchor.groups) {
    if (!marker_of(frame, group).allFinite()) {
      return false;
    }
  }
  return true;
}

HeadFree remove_head(const FrameMatrixD& frames, const HeadAnchor& anchor,
                     const Eigen::VectorXd& reference_pose, Scale scale) {
  const auto frame_count = static_cast<std::size_t>(frames.rows());
  HeadFree result;
  std::vector<SizedPose> poses(frame_count);
  std::vector<bool> known(frame_count, false);
  for (std::size_t k = 0; k < frame_count; ++k) {
    const Eigen::VectorXd frame = frames.row(static_cast<Eigen::Index>(k));
    if (const auto pose = pose_of_frame(frame, anchor, reference_pose, scale)) {
      poses[k] = *pose;
      known[k] = true;
      result.found = true;
    }
  }
  if (!result.found) {
    return result;
  }
  result.interpolated = interpolate_unknown(poses, known);
  result.local.resize(frames.rows(), frames.cols());
  for (std::size_t k = 0; k < frame_count; ++k) {
    HeadPose& pose = poses[k].pose;
    const bool flip =
        k == 0 ? pose.rotation.w() < 0.0 : pose.rotation.dot(poses[k - 1].pose.rotation) < 0.0;
    if (flip) {
      pose.rotation.coeffs() = -pose.rotation.coeffs();
    }
    const Eigen::Matrix3d back = pose.rotation.toRotationMatrix().transpose();
    const Eigen::Map<const Eigen::Matrix3Xd> markers(
        frames.row(static_cast<Eigen::Index>(k)).data(), 3, frames.cols() / 3);
    Eigen::Map<Eigen::Matrix3Xd> local(result.local.row(static_cast<Eigen::Index>(k)).data(), 3,
                                       frames.cols() / 3);
    local = back * (markers.colwise() - pose.translation_mm) / poses[k].size;
    result.head.push_back(pose);
    result.size.push_back(poses[k].size);
  }
  return result;
}

} // namespace phonomime
