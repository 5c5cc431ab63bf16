// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/inner_parts.h"

#include "synth/retarget/jaw_motion.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

// A skin of one triangle (its first corner at `root`), then pieces of one part each.
class Builder {
public:
  explicit Builder(const Eigen::RowVector3d& root) {
    add_box(root, root + Eigen::RowVector3d(1, 1, 0));
  }

  // Two triangles that span the box; returns the first vertex.
  int add_box(const Eigen::RowVector3d& low, const Eigen::RowVector3d& high) {
    const int first = static_cast<int>(rows_.size());
    rows_.insert(rows_.end(),
                 {low, {high.x(), low.y(), high.z()}, high, {low.x(), high.y(), low.z()}});
    parts_.push_back({.first_vertex = first,
                      .vertex_count = 4,
                      .first_triangle = first / 2,
                      .triangle_count = 2});
    return first;
  }

  TriangleMesh mesh() const {
    TriangleMesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(rows_.size()), 3);
    mesh.triangles.resize(static_cast<Eigen::Index>(rows_.size() / 2), 3);
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      mesh.positions.row(static_cast<Eigen::Index>(v)) = rows_[v];
    }
    for (int p = 0; p < static_cast<int>(parts_.size()); ++p) {
      mesh.triangles.row(2 * p) << 4 * p, 4 * p + 1, 4 * p + 2;
      mesh.triangles.row(2 * p + 1) << 4 * p, 4 * p + 2, 4 * p + 3;
    }
    mesh.parts = parts_;
    return mesh;
  }

private:
  std::vector<Eigen::RowVector3d> rows_;
  std::vector<MeshPart> parts_;
};

TEST(InnerParts, SortsTeethGumsEyesAndLashes) {
  Builder builder({0, 100, 50});
  const int upper = builder.add_box({-5, 0, -10}, {5, 10, -5});
  const int lower = builder.add_box({-5, -12, -10}, {5, -2, -5});
  const int gum = builder.add_box({-6, -14, -12}, {6, 12, -6});
  const int eye = builder.add_box({20, 58, -30}, {40, 78, -20});
  const int lash = builder.add_box({0, 100, 50}, {3, 104, 55});
  const int hat = builder.add_box({-50, 150, -30}, {50, 160, 30});
  const TriangleMesh mesh = builder.mesh();
  FacePlaces places;
  places.mouth = MouthPlace{.centre = {0, -1, 0}, .half_width = 25, .chin_y = -40};
  places.eyes = {{.centre = {-30, 70, -10}, .radius = 18}, {.centre = {30, 70, -10}, .radius = 18}};
  const InnerParts parts = sort_inner_parts(mesh, mesh.positions, places);
  const auto at = [&](int v) {
    return parts.vertices[static_cast<std::size_t>(v - mesh.skin_vertex_count())];
  };
  EXPECT_EQ(parts.jaw, 1);
  EXPECT_EQ(parts.shared, 1);
  EXPECT_EQ(parts.anchored, 1);
  EXPECT_EQ(parts.resting, 3);
  EXPECT_EQ(at(upper).jaw, 0.0);
  EXPECT_EQ(at(upper).place, kInMouth);
  EXPECT_EQ(at(lower).jaw, 1.0);
  EXPECT_EQ(at(eye).place, kInFirstEye + 1);
  EXPECT_EQ(at(eye).jaw, 0.0);
  EXPECT_EQ(at(hat).place, kNowhere);
  EXPECT_EQ(at(lash + 2).anchor, 0) << "the far end of a lash goes with its root";
  EXPECT_GT(at(gum).jaw, 0.8) << "close to the lower teeth";
  EXPECT_LT(at(gum + 2).jaw, 0.2) << "close to the upper teeth";
}

TEST(InnerParts, WithoutAMouthEverythingRests) {
  Builder builder({0, 100, 50});
  builder.add_box({-5, -12, -10}, {5, -2, -5});
  const TriangleMesh mesh = builder.mesh();
  const InnerParts parts = sort_inner_parts(mesh, mesh.positions, {});
  EXPECT_EQ(parts.resting, 1);
  EXPECT_EQ(parts.vertices[0].jaw, 0.0);
}

Points jaw_markers() {
  Points rest(5, 3);
  rest << 0, -60, 80, -20, -55, 70, 20, -55, 70, -50, -30, 10, 50, -30, 10;
  return rest;
}

TEST(JawMotion, RecoversASmallRigidMotion) {
  const Points rest = jaw_markers();
  const JawMotion jaw(rest);
  const Eigen::Vector3d turn(0.1, -0.02, 0.03);
  const Eigen::Vector3d shift(1, -8, -3);
  const Eigen::RowVector3d pivot = rest.colwise().mean();
  const auto moved = [&](const Eigen::RowVector3d& x) -> Eigen::RowVector3d {
    return shift.transpose() + turn.transpose().cross(x - pivot);
  };
  Points displacements(5, 3);
  for (int i = 0; i < 5; ++i) {
    displacements.row(i) = moved(rest.row(i));
  }
  const SmallMotion motion = jaw.fit(displacements);
  EXPECT_LT((motion.rotation - turn).norm(), 1e-12);
  const Eigen::RowVector3d tooth(3, -35, 95);
  EXPECT_LT((jaw.displacement(motion, tooth) - moved(tooth)).norm(), 1e-10);
}

TEST(JawMotion, IsLinear) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Points a = Points::NullaryExpr(5, 3, [&] { return normal(random); });
  const Points b = Points::NullaryExpr(5, 3, [&] { return normal(random); });
  const JawMotion jaw(jaw_markers());
  const Eigen::RowVector3d tooth(3, -35, 95);
  const auto at = [&](const Points& d) { return jaw.displacement(jaw.fit(d), tooth); };
  EXPECT_LT((at(2.0 * a - 3.0 * b) - (2.0 * at(a) - 3.0 * at(b))).norm(), 1e-10);
}

TEST(JawMotion, FewMarkersOnlyCarry) {
  for (const int count : {1, 2}) {
    const JawMotion jaw(jaw_markers().topRows(count));
    Points down = Points::Zero(count, 3);
    down.col(1).setConstant(-4.0);
    EXPECT_LT((jaw.displacement(jaw.fit(down), {9, 9, 9}) - Eigen::RowVector3d(0, -4, 0)).norm(),
              1e-12);
  }
}

} // namespace
} // namespace phonomime
