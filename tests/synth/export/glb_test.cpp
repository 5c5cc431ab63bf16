// SPDX-License-Identifier: GPL-3.0-or-later
// The files that these tests leave in PHONOMIME_GLB_FOLDER are read by read_glb.py and by Khronos'
// validator afterwards.
#include "synth/export/glb.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "synth/retarget/mesh_reader.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/glb_bytes.h"
#include "tests/synth/retarget/made_mesh.h"
#include "tests/synth/retarget/real_motion.h"

#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

nlohmann::json json_of(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  return nlohmann::json::parse(glb.substr(20, size));
}

// Leaves NAME.glb and what E11 and E15 give at the times (s), head pose included.
void leave(const std::string& name, const std::string& glb, const MarkerFace& face,
           const PcaModel& pca, const CoefficientMotion& motion, const std::vector<double>& times) {
  std::string expected;
  test::append_bytes(expected, static_cast<std::uint32_t>(times.size()));
  test::append_bytes(expected, static_cast<std::uint32_t>(face.mesh().vertex_count()));
  for (const double time : times) {
    const double at = time * motion.rate_hz;
    const auto before = static_cast<Eigen::Index>(std::floor(at + 1e-9));
    const auto after = std::min(before + 1, motion.coefficients.rows() - 1);
    const double part = at - static_cast<double>(before);
    const Eigen::VectorXd c = (1.0 - part) * motion.coefficients.row(before).transpose() +
                              part * motion.coefficients.row(after).transpose();
    Points shape = face.deform(pca.reconstruct(c));
    if (!motion.head.empty()) {
      const HeadPose& pose = motion.head[static_cast<std::size_t>(before)];
      shape = shape * pose.rotation.toRotationMatrix().transpose();
      shape.rowwise() += pose.translation_mm.transpose();
    }
    test::append_bytes(expected, time);
    for (const double value : shape.reshaped<Eigen::RowMajor>()) {
      test::append_bytes(expected, value);
    }
  }
  const std::filesystem::path folder = PHONOMIME_GLB_FOLDER;
  write_file(folder / (name + ".glb"), glb);
  write_file(folder / (name + ".expected"), expected);
}

// A bent sheet of 20 by 16 mm with eight markers, and a piece besides the skin.
struct MadeFace {
  Layout layout = test::made_layout({{"a", {}, ""},
                                     {"b", {}, ""},
                                     {"c", {}, ""},
                                     {"d", {}, ""},
                                     {"e", {}, ""},
                                     {"f", {}, ""},
                                     {"g", {}, ""},
                                     {"h", {}, ""}});
  FaceSource source;
  Eigen::VectorXd reference;
  PcaModel pca;
  CoefficientMotion motion;

  MadeFace() {
    const TriangleMesh skin = test::grid(21, 17, 0.2, 4);
    TriangleMesh& mesh = source.mesh;
    mesh = skin;
    mesh.positions.conservativeResize(skin.vertex_count() + 3, 3);
    mesh.positions.bottomRows(3) << 5, 5, -3, 9, 5, -3, 5, 9, -3;
    mesh.triangles.conservativeResize(skin.triangle_count() + 1, 3);
    mesh.triangles.bottomRows(1) << skin.vertex_count(), skin.vertex_count() + 1,
        skin.vertex_count() + 2;
    mesh.materials = {{.name = "white", .base_color = {0.9, 0.9, 0.8, 1}, .double_sided = true}};
    mesh.parts.push_back({.first_vertex = skin.vertex_count(),
                          .vertex_count = 3,
                          .first_triangle = skin.triangle_count(),
                          .triangle_count = 1,
                          .material = 0});
    source.markers.vertices = {0,           10,          20,      5 * 21 + 4,
                               8 * 21 + 15, 12 * 21 + 9, 16 * 21, 16 * 21 + 20};
    reference = test::as_frame(mesh.positions, source.markers.vertices);
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    pca.mean = reference + Eigen::VectorXd::Constant(reference.size(), 0.5);
    const Eigen::MatrixXd any = Eigen::MatrixXd::NullaryExpr(24, 5, [&] { return normal(random); });
    pca.basis = Eigen::MatrixXd(any.householderQr().householderQ()).leftCols(5);
    pca.variance = Eigen::VectorXd::Ones(5);
    motion.rate_hz = 30.0;
    motion.coefficients.resize(40, 5);
    for (int frame = 0; frame < 40; ++frame) {
      const double k = frame;
      motion.coefficients.row(frame) << 6 * std::sin(0.2 * k), 3 * std::cos(0.31 * k), 0,
          -2 + 0.1 * k, 1e-3 * k;
      motion.head.push_back({.translation_mm = {0.5 * k, 100 - k, 3},
                             .rotation = Eigen::Quaterniond(Eigen::AngleAxisd(
                                 0.02 * k, Eigen::Vector3d(1, 2, 0).normalized()))});
    }
  }
};

TEST(Glb, HoldsWhatDesignAsksFor) {
  const MadeFace made;
  const MarkerFace face(made.source, made.layout, made.reference);
  const std::string glb =
      marker_face_glb(face.mesh(), face.morphs(made.pca), made.motion,
                      {.title = "a <title>", .credits = {"someone"}, .synthetic = true});
  leave("made", glb, face, made.pca, made.motion, {0.0, 1.0 / 30, 0.5, 39.0 / 30});
  const nlohmann::json json = json_of(glb);
  EXPECT_EQ(json["asset"]["generator"], "Phonomime");
  EXPECT_EQ(json["asset"]["extras"]["credits"][0], "someone");
  EXPECT_EQ(json["asset"]["extras"]["synthetic"], true);
  EXPECT_EQ(json["nodes"][0]["name"], "head");
  const auto& mesh = json["meshes"][0];
  EXPECT_EQ(mesh["extras"]["targetNames"].size(), 4u) << "one of five dimensions does not move";
  ASSERT_EQ(mesh["primitives"].size(), 2u);
  EXPECT_EQ(json["accessors"][mesh["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()]
                ["count"],
            face.mesh().skin_vertex_count());
  EXPECT_EQ(json["materials"][mesh["primitives"][1]["material"].get<std::size_t>()]["name"],
            "white");
  EXPECT_EQ(json["animations"][0]["channels"].size(), 3u) << "weights, rotation and translation";
  EXPECT_EQ(glb,
            marker_face_glb(face.mesh(), face.morphs(made.pca), made.motion,
                            {.title = "a <title>", .credits = {"someone"}, .synthetic = true}));
}

TEST(Glb, LeavesTheHeadAloneWhereItRests) {
  MadeFace made;
  made.motion.head.clear();
  const MarkerFace face(made.source, made.layout, made.reference);
  const std::string glb = marker_face_glb(face.mesh(), face.morphs(made.pca), made.motion, {});
  leave("resting_head", glb, face, made.pca, made.motion, {0.0, 0.7 / 30, 0.31, 39.0 / 30});
  EXPECT_EQ(json_of(glb)["animations"][0]["channels"].size(), 1u);
}

// Phonomime's own reader takes its own file: base shape, parts and materials come back.
TEST(Glb, CanBeAFaceAgain) {
  MadeFace made;
  made.motion.head.clear();
  const MarkerFace face(made.source, made.layout, made.reference);
  const MorphTargets morphs = face.morphs(made.pca);
  const TriangleMesh again =
      parse_glb(marker_face_glb(face.mesh(), morphs, made.motion, {}), "again.glb");
  ASSERT_EQ(again.vertex_count(), face.mesh().vertex_count());
  EXPECT_LT((1000.0 * again.positions - morphs.base).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(again.triangles, face.mesh().triangles);
  EXPECT_EQ(again.parts.size(), 2u);
}

TEST(Glb, HoldsAStillFace) {
  MadeFace made;
  made.motion.head.clear();
  made.motion.coefficients = FrameMatrixD::Zero(1, 5);
  const MarkerFace face(made.source, made.layout, made.reference);
  const nlohmann::json json =
      json_of(marker_face_glb(face.mesh(), face.morphs(made.pca), made.motion, {}));
  EXPECT_FALSE(json.contains("animations"));
  EXPECT_FALSE(json["meshes"][0]["primitives"][0].contains("targets"));
}

TEST(Glb, RefusesWhatDoesNotFit) {
  MadeFace made;
  const MarkerFace face(made.source, made.layout, made.reference);
  made.motion.coefficients.conservativeResize(40, 4);
  EXPECT_THROW(marker_face_glb(face.mesh(), face.morphs(made.pca), made.motion, {}), InternalError);
}

class GlbOfARealFace : public ::testing::TestWithParam<const char*> {};

TEST_P(GlbOfARealFace, IsLeftForTheReaders) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const test::RealMotion real = test::read_real_motion(data, 100);
  const MarkerFace face(read_face(data / "faces" / GetParam(), real.layout), real.layout,
                        real.reference);
  CoefficientMotion motion;
  motion.rate_hz = 25.0;
  motion.coefficients =
      (real.channels.topRows(75).rowwise() - real.pca.mean.transpose()) * real.pca.basis;
  leave(GetParam(),
        marker_face_glb(face.mesh(), face.morphs(real.pca), motion, {.title = GetParam()}), face,
        real.pca, motion, {0.0, 1.2, 1.33, 74.0 / 25});
}

INSTANTIATE_TEST_SUITE_P(Faces, GlbOfARealFace, ::testing::Values("canonical", "ict"));

} // namespace
} // namespace phonomime
