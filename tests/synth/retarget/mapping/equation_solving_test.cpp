// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/equation_solving.h"
#include "synth/retarget/mapping/region_errors.h"
#include "tests/support/expect_error.h"
#include "tests/synth/retarget/mapping/made_pairs.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

// 20 vertices that three half turns bring onto themselves (their axes of inertia are x, y and z),
// and three shapes.
ShapeFace made_face() {
  ShapeFace face;
  const Points half = made_matrix(5, 3, 1.0, 1);
  face.neutral.source = "made.glb";
  face.neutral.positions.resize(20, 3);
  face.neutral.positions << half, half * Eigen::Vector3d(1, -1, -1).asDiagonal(),
      half * Eigen::Vector3d(-1, 1, -1).asDiagonal(),
      half * Eigen::Vector3d(-1, -1, 1).asDiagonal();
  face.neutral.positions *= Eigen::Vector3d(1.0, 0.8, 0.4).asDiagonal();
  face.names = {"a", "b", "c"};
  for (unsigned s = 0; s < 3; ++s) {
    face.offsets.emplace_back(made_matrix(20, 3, 0.1, 10 + s));
  }
  return face;
}

Points shape_at(const ShapeFace& face, const Eigen::RowVectorXd& weights) {
  Points shape = face.neutral.positions;
  for (std::size_t s = 0; s < face.offsets.size(); ++s) {
    shape += weights(static_cast<Eigen::Index>(s)) * face.offsets[s];
  }
  return shape;
}

Eigen::VectorXd flat(const Points& points) {
  return Eigen::Map<const Eigen::VectorXd>(points.data(), points.size());
}

const std::vector<int> kVertices = {4, 9, 14, 19, 0, 5, 10, 15, 17, 12, 7, 2};

// What a speaker's markers do who looks like the face, but for `stretch` on each axis.
FrameMatrixD performed(const ShapeFace& face, const FrameMatrixD& weights,
                       const Eigen::Vector3d& stretch) {
  FrameMatrixD channels(weights.rows(), 3 * static_cast<Eigen::Index>(kVertices.size()));
  for (Eigen::Index k = 0; k < weights.rows(); ++k) {
    const Points shape = shape_at(face, weights.row(k)) * stretch.asDiagonal();
    channels.row(k) = flat(shape(kVertices, Eigen::all)).transpose();
  }
  return channels;
}

FrameMatrixD made_weights(Eigen::Index frames) {
  return (made_matrix(frames, 3, 0.5, 20).array() + 0.5).matrix();
}

EquationSolver solver_of(const ShapeFace& face, const Eigen::Vector3d& stretch) {
  const FrameMatrixD rest = performed(face, FrameMatrixD::Zero(1, 3), stretch);
  return EquationSolver(shapes_at_markers(face, kVertices, rest.row(0).transpose()));
}

} // namespace

TEST(MarkerShapes, AreInTheMarkersAxesAndUnit) {
  const ShapeFace face = made_face();
  Similarity move;
  move.scale = 90.0;
  move.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  move.translation = Eigen::Vector3d(5, -7, 11);
  const Points rest = move.apply(face.neutral.positions);
  std::vector<int> vertices = kVertices;
  vertices[3] = -1;
  const MarkerShapes shapes = shapes_at_markers(face, vertices, flat(rest(kVertices, Eigen::all)));
  const Points moved = move.apply(shape_at(face, Eigen::RowVector3d(0.2, 0.0, 0.9)));
  const Eigen::VectorXd found = shapes.rest + shapes.offsets * Eigen::Vector3d(0.2, 0.0, 0.9);
  for (Eigen::Index g = 0; g < 12; ++g) {
    if (g == 3) {
      EXPECT_EQ(shapes.on_face[3], 0);
      EXPECT_EQ(shapes.offsets.middleRows(9, 3).norm(), 0.0);
      continue;
    }
    EXPECT_LT(
        (found.segment<3>(3 * g).transpose() - moved.row(vertices[static_cast<std::size_t>(g)]))
            .norm(),
        1e-9);
  }
}

TEST(MarkerShapes, RefuseAFaceWithoutShapesAndOneThatLiesElsewhere) {
  ShapeFace face = made_face();
  const Eigen::VectorXd rest = flat(face.neutral.positions(kVertices, Eigen::all));
  const std::vector<int> shuffled(kVertices.rbegin(), kVertices.rend());
  expect_error([&] { shapes_at_markers(face, shuffled, rest); },
               "made.glb: the markers' vertices do not have the shape of the markers at rest");
  face.names.clear();
  face.offsets.clear();
  expect_error([&] { shapes_at_markers(face, kVertices, rest); },
               "made.glb: the face has no blendshapes");
}

TEST(EquationSolver, SolvesX7WhereTheSpeakerLooksLikeTheFace) {
  const ShapeFace face = made_face();
  const FrameMatrixD weights = made_weights(40);
  const EquationSolver solver = solver_of(face, {100, 100, 100});
  EXPECT_LT((solver.proportions() - Eigen::Vector3d::Ones()).norm(), 1e-9);
  EXPECT_LT(
      (solver.weights(performed(face, weights, {100, 100, 100})) - weights).cwiseAbs().maxCoeff(),
      1e-9);
}

TEST(EquationSolver, ScalesEachAxis) {
  const ShapeFace face = made_face();
  const FrameMatrixD weights = made_weights(40);
  const Eigen::Vector3d stretch(100, 115, 90);
  const EquationSolver solver = solver_of(face, stretch);
  EXPECT_LT((solver.weights(performed(face, weights, stretch)) - weights).cwiseAbs().maxCoeff(),
            1e-9);
}

TEST(EquationSolver, LeavesMissingMarkersOut) {
  const ShapeFace face = made_face();
  const FrameMatrixD weights = made_weights(3);
  FrameMatrixD channels = performed(face, weights, {100, 100, 100});
  channels.row(1).segment(6, 3).setConstant(std::numeric_limits<double>::quiet_NaN());
  channels.row(2).setConstant(std::numeric_limits<double>::quiet_NaN());
  const FrameMatrixD found = solver_of(face, {100, 100, 100}).weights(channels);
  EXPECT_LT((found - weights).topRows(2).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(found.row(2).norm(), 0.0);
}

TEST(RegionErrors, AreDistancesFromTheVerticesUnderTheMarkers) {
  const ShapeFace face = made_face();
  const FrameMatrixD weights = made_weights(4);
  FrameMatrixD channels = performed(face, weights, {100, 100, 100});
  const MarkerShapes shapes = shapes_at_markers(
      face, kVertices, performed(face, FrameMatrixD::Zero(1, 3), {100, 100, 100}).transpose());
  Layout layout;
  for (std::size_t g = 0; g < kVertices.size(); ++g) {
    layout.groups.push_back({.name = "m" + std::to_string(g), .regions = {Region::jaw}});
  }
  layout.groups[2].regions = {Region::lips};
  layout.groups[3].regions = {Region::lips, Region::cheeks};
  channels(1, 3 * 2) += 3.0; // of eight distances one is 5 mm
  channels(1, 3 * 2 + 1) += 4.0;
  channels.row(2).segment(3 * 5, 3).setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto errors = region_errors(shapes, layout, channels, weights);
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_EQ(errors[0].region, Region::lips);
  EXPECT_EQ(errors[0].markers, 2);
  EXPECT_NEAR(errors[0].rms_mm, std::sqrt(25.0 / 8.0), 1e-9);
  EXPECT_EQ(errors[1].markers, 10);
  EXPECT_NEAR(errors[1].rms_mm, 0.0, 1e-9);
  EXPECT_EQ(errors[2].region, Region::cheeks);
}

} // namespace phonomime::test
