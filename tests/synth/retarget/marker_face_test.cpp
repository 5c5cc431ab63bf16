// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/marker_face.h"

#include "db/types/errors.h"
#include "tests/synth/retarget/made_mesh.h"

#include <random>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr int kColumns = 41;

int vertex(int x, int y) {
  return y * kColumns + x;
}

// A bent sheet with a filled mouth, seven markers on it.
class MarkerFaceTest : public ::testing::Test {
protected:
  MarkerFaceTest() {
    for (Eigen::Index v = 0; v < mesh_.positions.rows(); ++v) {
      mesh_.positions(v, 2) = -0.02 * std::pow(mesh_.positions(v, 0) - 20.0, 2);
    }
  }

  FaceSource source() const {
    FaceSource face{.mesh = mesh_, .markers = {}};
    face.markers.vertices = vertices_;
    return face;
  }

  PcaModel random_pca(const Eigen::VectorXd& mean, unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    PcaModel pca;
    pca.mean = mean;
    const Eigen::MatrixXd any =
        Eigen::MatrixXd::NullaryExpr(mean.size(), 4, [&] { return normal(random); });
    pca.basis = Eigen::MatrixXd(any.householderQr().householderQ()).leftCols(4);
    pca.variance = Eigen::Vector4d(9, 4, 2, 1);
    return pca;
  }

  TriangleMesh mesh_ = test::grid(kColumns, 31);
  std::vector<int> vertices_ = {vertex(10, 10), vertex(20, 12), vertex(30, 10), vertex(20, 8),
                                vertex(20, 2),  vertex(8, 26),  vertex(33, 27)};
  Layout layout_ = test::made_layout({{"right", {Region::lips}, "mouth_corner_right"},
                                      {"upper", {Region::lips}, "lip_upper_inner"},
                                      {"left", {Region::lips}, "mouth_corner_left"},
                                      {"lower", {Region::lips}, "lip_lower_inner"},
                                      {"chin", {Region::jaw}, "chin"},
                                      {"brow_r", {Region::brows}, ""},
                                      {"brow_l", {Region::brows}, ""}});
};

TEST_F(MarkerFaceTest, PlacesTheFaceOnTheReferencePose) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Points expected = 3.0 * mesh_.positions * turn.transpose();
  expected.rowwise() += Eigen::RowVector3d(-30, -90, 7);
  const MarkerFace face(source(), layout_, test::as_frame(expected, vertices_));
  EXPECT_LT((face.mesh().positions - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(face.report().placement.scale, 3.0, 1e-10);
  EXPECT_LT(face.report().largest_offset_mm, 1e-9);
  ASSERT_EQ(face.report().cut.size(), 1u);
  EXPECT_EQ(face.landmarks().at("chin"), vertex(20, 2));
  EXPECT_LT((face.deform(test::as_frame(expected, vertices_)) - face.mesh().positions).norm(),
            1e-12);
}

// Lips and lids are brought to the reference pose, nothing else is.
TEST_F(MarkerFaceTest, ClosesTheLipsAtTheReferencePose) {
  Eigen::VectorXd reference = test::as_frame(mesh_.positions, vertices_);
  reference(3 * 1 + 1) -= 2.0;
  reference(3 * 3 + 1) += 2.0; // lips meet
  const MarkerFace face(source(), layout_, reference);
  const Points& rest = face.mesh().positions;
  EXPECT_LT(std::abs(rest(vertices_[1], 1) - rest(vertices_[3], 1)), 0.3)
      << "4 mm apart in the file";
  const Points placed = face.report().placement.apply(mesh_.positions);
  for (const int brow : {5, 6}) {
    EXPECT_LT((rest - placed).row(vertices_[static_cast<std::size_t>(brow)]).norm(), 0.1);
  }
}

TEST_F(MarkerFaceTest, MorphsAreTheDeformation) {
  const Eigen::VectorXd reference = test::as_frame(mesh_.positions, vertices_);
  const MarkerFace face(source(), layout_, reference);
  const PcaModel pca = random_pca(reference + Eigen::VectorXd::Constant(reference.size(), 0.3), 5);
  const MorphTargets targets = face.morphs(pca);
  std::mt19937 random(6);
  std::normal_distribution<double> normal(0.0, 4.0);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd c = Eigen::VectorXd::NullaryExpr(4, [&] { return normal(random); });
    EXPECT_LT((targets.at(c) - face.deform(pca.reconstruct(c))).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST_F(MarkerFaceTest, MovesAVertexByTheMarkerThatSitsOnIt) {
  const Eigen::VectorXd reference = test::as_frame(mesh_.positions, vertices_);
  const MarkerFace face(source(), layout_, reference);
  Eigen::VectorXd frame = reference;
  frame.segment<3>(12) += Eigen::Vector3d(1, -5, 2); // the chin, far from the others
  const Points moved = face.deform(frame) - face.mesh().positions;
  EXPECT_LT((moved.row(vertices_[4]) - Eigen::RowVector3d(1, -5, 2)).norm(), 0.15);
  Eigen::VectorXd shifted = reference;
  for (int g = 0; g < 7; ++g) {
    shifted.segment<3>(3 * g) += Eigen::Vector3d(1, -5, 2);
  }
  const Points together = face.deform(shifted) - face.mesh().positions;
  for (const int v : vertices_) {
    EXPECT_LT((together.row(v) - Eigen::RowVector3d(1, -5, 2)).norm(), 0.05);
  }
}

TEST_F(MarkerFaceTest, ReportsTheShareOfTheApertureThatItKeeps) {
  const Eigen::VectorXd reference = test::as_frame(mesh_.positions, vertices_);
  const PcaModel pca = random_pca(reference, 8);
  const MarkerFace face(source(), layout_, reference);
  // The same over many random frames of that model.
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  double ab = 0.0;
  double aa = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::VectorXd c = pca.variance.cwiseSqrt().cwiseProduct(
        Eigen::VectorXd::NullaryExpr(4, [&] { return normal(random); }));
    const Eigen::VectorXd frame = pca.reconstruct(c);
    const auto opening = [&](const Eigen::VectorXd& f) { return f(3 * 1 + 1) - f(3 * 3 + 1); };
    const double a = opening(frame) - opening(reference);
    const Points& rest = face.mesh().positions;
    if (i % 10 == 0) {
      const Points shape = face.deform(frame);
      const double b = shape(vertices_[1], 1) - shape(vertices_[3], 1) -
                       (rest(vertices_[1], 1) - rest(vertices_[3], 1));
      ab += a * b;
      aa += a * a;
    }
  }
  ASSERT_TRUE(face.aperture_share(pca));
  EXPECT_NEAR(*face.aperture_share(pca), ab / aa, 0.02);
  EXPECT_GT(*face.aperture_share(pca), 0.9);
  Layout bare = layout_;
  bare.landmarks.clear();
  EXPECT_FALSE(MarkerFace(source(), bare, reference).aperture_share(pca));
}

TEST_F(MarkerFaceTest, RefusesMarkersThatDoNotFit) {
  Eigen::VectorXd reference = test::as_frame(mesh_.positions, vertices_);
  std::vector<int> wrong = {vertices_[6], vertices_[2], vertices_[0], vertices_[5],
                            vertices_[1], vertices_[4], vertices_[3]};
  FaceSource face = source();
  face.markers.vertices = wrong;
  try {
    MarkerFace(std::move(face), layout_, reference);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what())
                    .starts_with("made.obj: the markers' vertices do not have the shape"))
        << error.what();
  }
}

} // namespace
} // namespace phonomime
