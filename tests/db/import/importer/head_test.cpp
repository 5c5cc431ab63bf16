// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/head.h"

#include "db/import/reference_pose.h"
#include "db/types/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace phonomime {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Six rigid markers and two that move, in mm.
Layout face_layout() {
  Layout layout;
  for (int i = 0; i < 8; ++i) {
    layout.groups.push_back({"m" + std::to_string(i), {}});
    layout.groups.back().regions.push_back(i < 6 ? Region::rigid : Region::lips);
  }
  return layout;
}

Eigen::VectorXd face_pose() {
  Eigen::VectorXd pose(24);
  pose << -45, 20, 0, 45, 20, 0, -20, 25, 12, 20, 25, 12, 0, 60, 5, 0, 5, 25, -15, -40, 15, 15, -42,
      16;
  return pose;
}

Eigen::Quaterniond turn(double yaw, double pitch, double roll) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) *
                            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
}

Eigen::VectorXd posed(const Eigen::VectorXd& local, const HeadPose& pose) {
  Eigen::VectorXd frame(local.size());
  for (Eigen::Index i = 0; i < local.size(); i += 3) {
    frame.segment<3>(i) = pose.rotation * local.segment<3>(i) + pose.translation_mm;
  }
  return frame;
}

double difference(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return (a.toRotationMatrix() - b.toRotationMatrix()).norm();
}

TEST(Head, RecoversKnownPosesAndTheFaceBelowThem) {
  const HeadAnchor anchor = head_anchor(face_layout());
  const Eigen::VectorXd reference = centred_on_anchor(face_pose(), anchor);
  const Eigen::Index count = 40;
  FrameMatrixD frames(count, 24);
  FrameMatrixD local(count, 24);
  std::vector<HeadPose> poses(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = 0.2 * static_cast<double>(k);
    poses[static_cast<std::size_t>(k)] = {
        .translation_mm = {30.0 * std::sin(t), -12.0 + t, 400.0 * std::cos(0.3 * t)},
        .rotation = turn(3.0 * std::sin(0.7 * t), 0.9 * std::cos(t), 0.4 * t)};
    local.row(k) = reference.transpose();
    local.row(k).segment<3>(18) += Eigen::RowVector3d(3 * std::sin(5 * t), 8 * std::cos(3 * t), t);
    frames.row(k) = posed(local.row(k).transpose(), poses[static_cast<std::size_t>(k)]).transpose();
  }
  const HeadFree free = remove_head(frames, anchor, reference, Scale::measured);
  ASSERT_TRUE(free.found);
  EXPECT_EQ(free.interpolated, 0);
  EXPECT_LT((free.local - local).cwiseAbs().maxCoeff(), 1e-9);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_LT(difference(free.head[k].rotation, poses[k].rotation), 1e-9) << k;
    EXPECT_LT((free.head[k].translation_mm - poses[k].translation_mm).norm(), 1e-9) << k;
    EXPECT_LT((posed(free.local.row(static_cast<Eigen::Index>(k)).transpose(), free.head[k]) -
               frames.row(static_cast<Eigen::Index>(k)).transpose())
                  .norm(),
              1e-9);
    if (k > 0) {
      EXPECT_GT(free.head[k].rotation.dot(free.head[k - 1].rotation), 0.0) << k;
    }
  }
}

TEST(Head, ANominalScaleIsTakenOffWithTheHeadMotion) {
  const HeadAnchor anchor = head_anchor(face_layout());
  const Eigen::VectorXd reference = centred_on_anchor(face_pose(), anchor);
  FrameMatrixD local(30, 24);
  FrameMatrixD frames(30, 24);
  std::vector<double> sizes;
  for (Eigen::Index k = 0; k < local.rows(); ++k) {
    const double t = 0.3 * static_cast<double>(k);
    local.row(k) = reference.transpose();
    local.row(k).segment<3>(18) += Eigen::RowVector3d(2 * std::sin(t), 8 * std::cos(t), t);
    sizes.push_back(1.0 + 0.1 * std::sin(0.5 * t));
    frames.row(k) = posed(sizes.back() * local.row(k).transpose(),
                          {.translation_mm = {10 * t, -t, 400.0}, .rotation = turn(t, 0.2, 0.1)})
                        .transpose();
  }
  frames.row(7).head(12).setConstant(kMissing); // two rigid markers are left: no pose, no size
  const HeadFree free = remove_head(frames, anchor, reference, Scale::nominal);
  EXPECT_EQ(free.interpolated, 1);
  for (Eigen::Index k = 0; k < local.rows(); ++k) {
    const double size = free.size[static_cast<std::size_t>(k)];
    if (k == 7) {
      EXPECT_NEAR(size, 0.5 * (sizes[6] + sizes[8]), 1e-9);
      continue;
    }
    EXPECT_NEAR(size, sizes[static_cast<std::size_t>(k)], 1e-9);
    EXPECT_LT((free.local.row(k) - local.row(k)).cwiseAbs().maxCoeff(), 1e-9) << k;
  }
  const HeadFree as_recorded = remove_head(frames, anchor, reference, Scale::measured);
  EXPECT_EQ(as_recorded.size, std::vector<double>(30, 1.0));
  EXPECT_GT((as_recorded.local.row(5) - local.row(5)).norm(), 1.0);
}

TEST(Head, AMirroredFaceStillGivesARotation) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 20.0);
  for (int round = 0; round < 200; ++round) {
    Eigen::Matrix3Xd reference(3, 5);
    for (double& value : reference.reshaped()) {
      value = normal(random);
    }
    if (round % 2 == 0) {
      reference.row(2).setZero(); // flat: the reflection through its plane fits as well
    }
    Eigen::Matrix3Xd mirrored = reference;
    mirrored.row(0) = -mirrored.row(0);
    const std::optional<HeadPose> pose = fit_pose(reference, mirrored);
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->rotation.toRotationMatrix().determinant(), 1.0, 1e-9);
    // No small turn of the answer fits better.
    const auto misfit = [&](const Eigen::Matrix3d& rotation) {
      return (rotation * (reference.colwise() - reference.rowwise().mean()) -
              (mirrored.colwise() - mirrored.rowwise().mean()))
          .squaredNorm();
    };
    const Eigen::Matrix3d best = pose->rotation.toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double angle : {-0.01, 0.01}) {
        EXPECT_LE(misfit(best),
                  misfit(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)) * best) + 1e-6);
      }
    }
  }
}

TEST(Head, UsesTheRigidMarkersThatAreThereElseTheFramesAround) {
  const HeadAnchor anchor = head_anchor(face_layout());
  const Eigen::VectorXd reference = centred_on_anchor(face_pose(), anchor);
  FrameMatrixD frames(5, 24);
  std::vector<HeadPose> poses;
  for (Eigen::Index k = 0; k < 5; ++k) {
    poses.push_back({.translation_mm = {10.0 * static_cast<double>(k), 0, 0},
                     .rotation = turn(0.1 * static_cast<double>(k), 0, 0)});
    frames.row(k) = posed(reference, poses.back()).transpose();
  }
  frames.row(1).segment(0, 9).setConstant(kMissing);  // three of six are left
  frames.row(2).segment(0, 12).setConstant(kMissing); // two are left
  frames.row(4).setConstant(kMissing);
  const HeadFree free = remove_head(frames, anchor, reference, Scale::measured);
  EXPECT_EQ(free.interpolated, 2);
  for (const std::size_t k : {0u, 1u, 2u, 3u}) {
    EXPECT_LT(difference(free.head[k].rotation, poses[k].rotation), 1e-9) << k;
    EXPECT_LT((free.head[k].translation_mm - poses[k].translation_mm).norm(), 1e-9) << k;
  }
  EXPECT_LT(difference(free.head[4].rotation, poses[3].rotation), 1e-9);
  EXPECT_TRUE(std::isnan(free.local(2, 0)));
  EXPECT_LT((free.local.row(2).tail(12) - reference.tail(12).transpose()).norm(), 1e-9);
}

TEST(Head, FewerThanThreeRigidMarkersCentreOnTheReferenceMarker) {
  Layout layout = face_layout();
  for (ChannelGroup& group : layout.groups) {
    group.regions.clear();
  }
  EXPECT_THROW(head_anchor(layout), InputError);
  layout.reference = "m5";
  const HeadAnchor anchor = head_anchor(layout);
  EXPECT_FALSE(anchor.gives_rotation);
  const Eigen::VectorXd reference = centred_on_anchor(face_pose(), anchor);
  EXPECT_EQ(marker_of(reference, 5), Eigen::Vector3d::Zero());
  FrameMatrixD frames(1, 24);
  frames.row(0) =
      posed(face_pose(), {.translation_mm = {5, 6, 7}, .rotation = turn(0.2, 0, 0)}).transpose();
  const HeadFree free = remove_head(frames, anchor, reference, Scale::measured);
  EXPECT_TRUE(marker_of(free.local.row(0).transpose(), 5).isZero());
  EXPECT_EQ(free.head[0].rotation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(Head, PointsOnALineGiveNoPose) {
  Eigen::Matrix3Xd line(3, 4);
  line << 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3;
  EXPECT_FALSE(fit_pose(line, line));
}

TEST(ReferencePose, IsTheFrameNearestToTheMedianWhereverTheHeadIs) {
  const HeadAnchor anchor = head_anchor(face_layout());
  FrameMatrix frames(41, 24);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-0.5, 0.5);
  for (Eigen::Index k = 0; k < frames.rows(); ++k) {
    Eigen::VectorXd face = face_pose();
    // The mouth opens more from frame to frame; from 30 on it is wide open.
    face(19) -= k < 30 ? 0.1 * static_cast<double>(k) : 30.0;
    frames.row(k) = posed(face, {.translation_mm = {100 * angle(random), 0, 500},
                                 .rotation = turn(angle(random), angle(random), angle(random))})
                        .cast<float>()
                        .transpose();
  }
  EXPECT_EQ(frame_nearest_to_median(frames, anchor, Scale::measured), 20);
}

} // namespace
} // namespace phonomime
