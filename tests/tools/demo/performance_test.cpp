// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "tests/tools/demo/support.h"
#include "tools/demo/marker_layout.h"
#include "tools/demo/mask_face.h"
#include "tools/demo/performance.h"

namespace phonomime::demo {
namespace {

std::vector<Segment> sentence() {
  return sequence({{"pau", 0.2},
                   {"hh", 0.06},
                   {"ax", 0.05},
                   {"l", 0.07},
                   {"ow", 0.2},
                   {"m", 0.08},
                   {"ay", 0.18},
                   {"b", 0.06},
                   {"oy", 0.2},
                   {"pau", 0.3}});
}

Performance perform_as(std::size_t style, std::uint64_t seed) {
  return perform(sentence(), emotion_styles()[style], FaceFields(mask_face_model().rest), seed);
}

// Kabsch's fit of the rigid markers, independent of the maker's own bookkeeping.
MarkerPose without_head(const MarkerPose& measured, const MarkerPose& rest) {
  const std::vector<int> rigid = marker_layout().groups_in(Region::rigid);
  MarkerPose a(rigid.size(), 3);
  MarkerPose b(rigid.size(), 3);
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    a.row(static_cast<Eigen::Index>(i)) = rest.row(rigid[i]);
    b.row(static_cast<Eigen::Index>(i)) = measured.row(rigid[i]);
  }
  const Eigen::RowVector3d a_middle = a.colwise().mean();
  const Eigen::RowVector3d b_middle = b.colwise().mean();
  const Eigen::Matrix3d h = (b.rowwise() - b_middle).transpose() * (a.rowwise() - a_middle);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d turn = svd.matrixU() * flip * svd.matrixV().transpose();
  return ((measured.rowwise() - b_middle) * turn).rowwise() + a_middle;
}

TEST(Performance, KabschTakesTheHeadOff) {
  for (std::size_t style = 0; style < emotion_styles().size(); ++style) {
    const Performance performance = perform_as(style, 11);
    const MarkerPose rest = mask_face_model().rest;
    double moved_mm = 0.0;
    double sum_sq = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < performance.face.size(); ++k) {
      const MarkerPose error = without_head(performance.measured[k], rest) - performance.face[k];
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 8.0 * kNoise_mm);
      const Eigen::Vector3d chin = performance.face[k].row(marker_index(152));
      const Eigen::Vector3d in_room =
          performance.head[k].rotation * chin + performance.head[k].translation_mm;
      const Eigen::Vector3d measured_chin = performance.measured[k].row(marker_index(152));
      EXPECT_LT((in_room - measured_chin).norm(), 12.0 * kNoise_mm);
      sum_sq += error.squaredNorm();
      count += static_cast<double>(error.size());
      moved_mm =
          std::max(moved_mm, (performance.measured[k] - performance.face[k]).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(std::sqrt(sum_sq / count), 1.5 * kNoise_mm);
    EXPECT_GT(std::sqrt(sum_sq / count), 0.5 * kNoise_mm);
    EXPECT_GT(moved_mm, 2.0) << "the head has moved";
  }
}

TEST(Performance, HeadMovesAreRigidSmallAndSmooth) {
  const Performance performance = perform_as(2, 4);
  for (std::size_t k = 0; k < performance.head.size(); ++k) {
    const Eigen::Matrix3d& r = performance.head[k].rotation;
    EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
    EXPECT_GT(r.trace(), 1.0 + 2.0 * std::cos(0.35)) << "within 20 degrees";
    if (k > 0) {
      EXPECT_LT((r - performance.head[k - 1].rotation).norm(), 0.02);
    }
  }
}

TEST(Performance, RigidMarkersRestOnTheFace) {
  const Performance performance = perform_as(1, 4);
  const MarkerPose rest = mask_face_model().rest;
  for (const int marker : marker_layout().groups_in(Region::rigid))
    for (const MarkerPose& face : performance.face)
      EXPECT_EQ(face.row(marker), rest.row(marker));
}

TEST(Performance, EmotionsShowAtRest) {
  const auto first = [&](std::size_t style) { return perform_as(style, 9).face.front(); };
  const MarkerPose neutral = first(0);
  const MarkerPose happiness = first(1);
  const MarkerPose anger = first(2);
  const MarkerPose sadness = first(3);
  const auto height = [](const MarkerPose& pose, int vertex) {
    return pose(marker_index(vertex), 1);
  };
  EXPECT_GT(height(happiness, 61), height(neutral, 61) + 3.0);
  EXPECT_LT(height(sadness, 61), height(neutral, 61) - 2.0);
  EXPECT_LT(height(anger, 107), height(neutral, 107) - 3.0);
  EXPECT_GT(height(sadness, 107), height(neutral, 107) + 3.0);
}

TEST(Performance, SameSeedSameNumbers) {
  const Performance a = perform_as(0, 1);
  const Performance b = perform_as(0, 1);
  const Performance c = perform_as(0, 2);
  EXPECT_EQ(a.measured, b.measured);
  EXPECT_NE(a.measured, c.measured);
}

TEST(Performance, FramesReachTheEndOfTheSpeech) {
  const double end_s = sentence().back().end_s;
  const double frames = static_cast<double>(perform_as(0, 1).measured.size());
  EXPECT_LT((frames - 1.0) / kRate_hz, end_s);
  EXPECT_GE(frames / kRate_hz, end_s);
}

} // namespace
} // namespace phonomime::demo
