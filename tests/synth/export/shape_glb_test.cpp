// SPDX-License-Identifier: GPL-3.0-or-later
// The file that this test leaves in PHONOMIME_GLB_FOLDER is read by read_glb.py and by Khronos'
// validator afterwards.
#include "synth/export/shape_glb.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "synth/retarget/face_scene.h"
#include "tests/support/expect_error.h"
#include "tests/synth/retarget/glb_bytes.h"

#include <cmath>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr int kColumns = 6;
constexpr int kVertices = kColumns * kColumns;

// A sheet of 6 by 6 vertices, 10 mm apart, with two shapes, one of which no weights name.
struct MadeFace {
  Points rest = Points(kVertices, 3);
  Points raise = Points::Zero(kVertices, 3);
  std::string glb;

  MadeFace() {
    std::string binary;
    for (int v = 0; v < kVertices; ++v) {
      rest.row(v) << 10.0 * (v % kColumns), 10.0 * (v / kColumns), 0.1 * v;
      raise.row(v) << 0.0, 0.0, 0.2 * v;
    }
    const auto append = [&](const Points& points) {
      for (const double value : points.reshaped<Eigen::RowMajor>()) {
        test::append_bytes(binary, static_cast<float>(1e-3 * value));
      }
    };
    append(rest);
    append(raise);
    append(0.5 * raise);
    const std::size_t corners = binary.size();
    for (int v = 0; v + kColumns + 1 < kVertices; ++v) {
      if (v % kColumns + 1 < kColumns) {
        for (const int corner : {v, v + 1, v + kColumns}) {
          test::append_bytes(binary, static_cast<std::uint32_t>(corner));
        }
      }
    }
    nlohmann::json json = nlohmann::json::parse(R"({
      "asset": {"version": "2.0", "extras": {"owner": "ann"}}, "scene": 0,
      "scenes": [{"nodes": [0]}],
      "nodes": [{"name": "skin", "mesh": 0}],
      "meshes": [{"name": "sheet", "primitives": [{"attributes": {"POSITION": 0},
        "indices": 3, "targets": [{"POSITION": 1}, {"POSITION": 2}]}]}],
      "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
                      "samplers": [{"input": 0, "output": 0}]}]})");
    for (const std::size_t view : {0u, 1u, 2u}) {
      json["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", view * kVertices * 12}, {"byteLength", kVertices * 12}});
      const Points& points = view == 0 ? rest : raise;
      const double scale = view == 2 ? 0.5e-3 : 1e-3;
      nlohmann::json accessor = {
          {"bufferView", view}, {"componentType", 5126}, {"count", kVertices}, {"type", "VEC3"}};
      for (int axis = 0; axis < 3; ++axis) {
        accessor["min"].push_back(static_cast<float>(scale * points.col(axis).minCoeff()));
        accessor["max"].push_back(static_cast<float>(scale * points.col(axis).maxCoeff()));
      }
      json["accessors"].push_back(accessor);
    }
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", corners}, {"byteLength", binary.size() - corners}});
    json["accessors"].push_back({{"bufferView", 3},
                                 {"componentType", 5125},
                                 {"count", (binary.size() - corners) / 4},
                                 {"type", "SCALAR"}});
    json["buffers"] = {{{"byteLength", binary.size()}}};
    glb = test::glb_container(json.dump(), binary);
  }
};

ShapeMotion made_motion() {
  ShapeMotion motion;
  motion.weights = {.rate_hz = 25.0,
                    .groups = {"mesh0_target0", "elsewhere"},
                    .channels_per_group = 1,
                    .frames = FrameMatrix(20, 2)};
  motion.placement.scale = 1000.0;
  motion.placement.translation << 5.0, -20.0, 3.0;
  for (int frame = 0; frame < 20; ++frame) {
    motion.weights.frames.row(frame) << 0.5F - 0.5F * std::cos(0.4F * static_cast<float>(frame)),
        1.0F;
    motion.head.push_back(
        {.translation_mm = {0.1 * frame, -0.2 * frame, 1.0},
         .rotation =
             head_rotation({.yaw = 0.02 * frame, .pitch = 0.01 * frame, .roll = -0.015 * frame})});
  }
  return motion;
}

TEST(ShapeGlb, KeepsTheFileAndMovesItsShapes) {
  const MadeFace face;
  const ShapeMotion motion = made_motion();
  const std::string glb =
      animated_glb(face.glb, "sheet.glb", motion, {.title = "t", .credits = {"c"}});
  std::string expected;
  const std::vector<int> frames = {0, 7, 19};
  test::append_bytes(expected, static_cast<std::uint32_t>(frames.size()));
  test::append_bytes(expected, static_cast<std::uint32_t>(kVertices));
  for (const int frame : frames) {
    // In the speaker's axes, where the head's pose is one; and back on the face.
    const HeadPose& head = motion.head[static_cast<std::size_t>(frame)];
    Points shape = face.rest + motion.weights.frames(frame, 0) * face.raise;
    shape.rowwise() += motion.placement.translation.transpose();
    shape = shape * head.rotation.toRotationMatrix().transpose();
    shape.rowwise() += (head.translation_mm - motion.placement.translation).transpose();
    test::append_bytes(expected, frame / 25.0);
    for (const double value : shape.reshaped<Eigen::RowMajor>()) {
      test::append_bytes(expected, value);
    }
  }
  const std::filesystem::path folder = PHONOMIME_GLB_FOLDER;
  write_file(folder / "shapes.glb", glb);
  write_file(folder / "shapes.expected", expected);

  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  const auto json = nlohmann::json::parse(glb.substr(20, size));
  EXPECT_EQ(json["animations"].size(), 1u) << "what it had goes";
  EXPECT_EQ(json["asset"]["extras"]["owner"], "ann");
  EXPECT_EQ(json["asset"]["extras"]["title"], "t");
  EXPECT_EQ(json["meshes"][0]["extras"]["targetNames"],
            (nlohmann::json{"mesh0_target0", "mesh0_target1"}));
  const FaceScene again = parse_face_scene(glb, "again.glb");
  EXPECT_EQ(again.face.names.size(), 2u);
  EXPECT_EQ(again.nodes.front().name, "head");
}

TEST(ShapeGlb, LeavesTheNodesAloneWhereTheHeadRests) {
  const MadeFace face;
  ShapeMotion motion = made_motion();
  motion.head.clear();
  const FaceScene again = parse_face_scene(
      animated_glb(face.glb, "sheet.glb", motion, {.title = {}, .credits = {}}), "again.glb");
  EXPECT_EQ(again.nodes.size(), 1u);
}

TEST(ShapeGlb, RefusesWhatDoesNotFit) {
  const MadeFace face;
  ShapeMotion motion = made_motion();
  motion.head.pop_back();
  EXPECT_THROW(animated_glb(face.glb, "sheet.glb", motion, {}), InternalError);
  motion = made_motion();
  EXPECT_NE(test::input_error([&] {
              std::string elsewhere = face.glb;
              elsewhere.replace(elsewhere.rfind("byteLength"), 10, "uri\":\"a\",\"");
              animated_glb(elsewhere, "sheet.glb", motion, {});
            }).find("sheet.glb"),
            std::string::npos);
}

// Whatever the face's reader takes, the writer takes or refuses.
TEST(ShapeGlb, StandsDamagedFiles) {
  const MadeFace face;
  const ShapeMotion motion = made_motion();
  std::mt19937 random(3);
  int written = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes = face.glb;
    for (int change = 0; change < 1 + trial % 3; ++change) {
      bytes[12 + random() % 1500] = static_cast<char>(random());
    }
    try {
      parse_face_scene(bytes, "sheet.glb");
      written += animated_glb(bytes, "sheet.glb", motion, {}).empty() ? 0 : 1;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(written, 0);
}

} // namespace
} // namespace phonomime
