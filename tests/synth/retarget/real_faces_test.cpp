// SPDX-License-Identifier: GPL-3.0-or-later
// Real motion on the two faces of ../shared/data.
#include "synth/retarget/marker_face.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/real_motion.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

class RealFaces : public ::testing::TestWithParam<const char*> {};

double opening(const Layout& layout, const Eigen::VectorXd& frame) {
  return frame(3 * *layout.find_landmark("lip_upper_inner") + 1) -
         frame(3 * *layout.find_landmark("lip_lower_inner") + 1);
}

double opening(const MarkerFace& face, const Points& shape) {
  return shape(face.landmarks().at("lip_upper_inner"), 1) -
         shape(face.landmarks().at("lip_lower_inner"), 1);
}

// Skin triangles that face the other way than at rest, mm^2 at rest.
double flipped_area(const MarkerFace& face, const Points& shape) {
  const TriangleMesh& mesh = face.mesh();
  double area = 0.0;
  for (int t = 0; t < mesh.parts.front().triangle_count; ++t) {
    const auto normal = [&](const Points& at) -> Eigen::RowVector3d {
      const Eigen::RowVector3d a = at.row(mesh.triangles(t, 0));
      return (at.row(mesh.triangles(t, 1)) - a).cross(at.row(mesh.triangles(t, 2)) - a);
    };
    if (normal(mesh.positions).dot(normal(shape)) < 0.0) {
      area += 0.5 * normal(mesh.positions).norm();
    }
  }
  return area;
}

TEST_P(RealFaces, KeepTheApertureAndDoNotFold) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const test::RealMotion motion = test::read_real_motion(data, 40);
  const MarkerFace face(read_face(data / "faces" / GetParam(), motion.layout), motion.layout,
                        motion.reference);
  const double rest = opening(face, face.mesh().positions);
  EXPECT_NEAR(rest, opening(motion.layout, motion.reference), 0.4) << "the lips rest closed";
  double ab = 0.0;
  double aa = 0.0;
  double widest = 0.0;
  for (Eigen::Index k = 0; k < motion.channels.rows(); k += 5) {
    const Eigen::VectorXd frame = motion.channels.row(k).transpose();
    const double a = opening(motion.layout, frame) - opening(motion.layout, motion.reference);
    const Points shape = face.deform(frame);
    const double b = opening(face, shape) - rest;
    ab += a * b;
    aa += a * a;
    widest = std::max(widest, a);
    if (a < 12.0) {
      EXPECT_LT(flipped_area(face, shape), 5.0) << "frame " << k;
    }
  }
  ASSERT_GT(widest, 8.0);
  RecordProperty("share", std::to_string(ab / aa));
  EXPECT_GE(ab / aa, 0.9);
  EXPECT_LE(ab / aa, 1.1);
  EXPECT_NEAR(*face.aperture_share(motion.pca), ab / aa, 0.03);
}

TEST_P(RealFaces, AreTheSameWithTwoThreads) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const test::RealMotion motion = test::read_real_motion(data, 400);
  const auto shape = [&](int threads) {
    return MarkerFace(read_face(data / "faces" / GetParam(), motion.layout), motion.layout,
                      motion.reference, {.threads = threads})
        .deform(motion.pca.mean);
  };
  EXPECT_EQ(shape(1), shape(2));
}

INSTANTIATE_TEST_SUITE_P(Faces, RealFaces, ::testing::Values("canonical", "ict"));

// Vertices of the teeth that no skin hides from the front.
int visible_teeth(const TriangleMesh& mesh, const Points& shape, const MeshPart& teeth) {
  int visible = 0;
  for (int v = teeth.first_vertex; v < teeth.first_vertex + teeth.vertex_count; ++v) {
    const Eigen::RowVector3d tooth = shape.row(v);
    bool hidden = false;
    for (int t = 0; !hidden && t < mesh.parts.front().triangle_count; ++t) {
      const Eigen::RowVector3d a = shape.row(mesh.triangles(t, 0)) - tooth;
      if (a.head<2>().norm() > 15.0) {
        continue;
      }
      const Eigen::RowVector3d b = shape.row(mesh.triangles(t, 1)) - tooth;
      const Eigen::RowVector3d c = shape.row(mesh.triangles(t, 2)) - tooth;
      const double bc = b.x() * c.y() - b.y() * c.x();
      const double ca = c.x() * a.y() - c.y() * a.x();
      const double ab = a.x() * b.y() - a.y() * b.x();
      const bool covers = (bc >= 0 && ca >= 0 && ab >= 0) || (bc <= 0 && ca <= 0 && ab <= 0);
      hidden = covers && (bc * a.z() + ca * b.z() + ab * c.z()) / (bc + ca + ab) > 0.0;
    }
    visible += hidden ? 0 : 1;
  }
  return visible;
}

TEST(IctHead, TeethStayBehindClosedLipsAndShowBetweenOpenOnes) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const test::RealMotion motion = test::read_real_motion(data, 40);
  const MarkerFace face(read_face(data / "faces/ict", motion.layout), motion.layout,
                        motion.reference);
  EXPECT_EQ(face.report().inner.shared, 1) << "gums in one piece";
  EXPECT_EQ(face.report().inner.anchored, 2) << "lashes";
  EXPECT_EQ(face.report().inner.jaw, 16) << "lower teeth";
  EXPECT_EQ(face.report().inner.resting, 16 + 4) << "upper teeth and two pieces an eye";
  EXPECT_TRUE(face.report().cut.empty());
  const TriangleMesh& mesh = face.mesh();
  const MeshPart& teeth = mesh.parts[2];
  int closed = 0;
  Eigen::Index widest = 0;
  for (Eigen::Index k = 0; k < motion.channels.rows(); ++k) {
    const Eigen::VectorXd frame = motion.channels.row(k).transpose();
    if (opening(motion.layout, frame) >
        opening(motion.layout, motion.channels.row(widest).transpose())) {
      widest = k;
    }
    if (opening(motion.layout, frame) < 0.1 && closed < 8 && k % 7 == 0) {
      ++closed;
      EXPECT_LE(visible_teeth(mesh, face.deform(frame), teeth), 5) << "of 4412, frame " << k;
    }
  }
  EXPECT_EQ(closed, 8);
  EXPECT_GT(visible_teeth(mesh, face.deform(motion.channels.row(widest).transpose()), teeth), 100);
}

} // namespace
} // namespace phonomime
