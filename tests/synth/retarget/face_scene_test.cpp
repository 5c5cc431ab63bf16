// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/face_scene.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/expect_error.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"
#include "tests/synth/retarget/glb_bytes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using nlohmann::json;

// The two triangles of SmallGlb with morph targets: the first mesh has `smile` (dense: its vertices
// move by 1, 2, 3 along x) and `open` (sparse: vertex 2 alone, by -1 along y); the second has
// `open` too (dense and sparse at once: 1, 2, 3 along x, but vertex 0 by (0, 0, 4)).
struct ShapesGlb : test::SmallGlb {
  ShapesGlb() {
    binary.resize(44);
    for (const float value : {1.f, 0.f, 0.f, 2.f, 0.f, 0.f, 3.f, 0.f, 0.f}) { // at 44
      test::append_bytes(binary, value);
    }
    test::append_bytes<std::uint32_t>(binary, 2); // at 80
    for (const float value : {0.f, -1.f, 0.f}) {  // at 84
      test::append_bytes(binary, value);
    }
    test::append_bytes<std::uint32_t>(binary, 0); // at 96: a byte and its padding
    for (const float value : {0.f, 0.f, 4.f}) {   // at 100
      test::append_bytes(binary, value);
    }
    for (const auto& [offset, length] :
         {std::pair(44, 36), {80, 4}, {84, 12}, {96, 1}, {100, 12}}) {
      this->json["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
    }
    this->json["buffers"][0]["byteLength"] = binary.size();
    const auto sparse = [](int indices, int component, int values) {
      return nlohmann::json{{"count", 1},
                            {"indices", {{"bufferView", indices}, {"componentType", component}}},
                            {"values", {{"bufferView", values}}}};
    };
    nlohmann::json accessor = {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
    accessor["bufferView"] = 2;
    this->json["accessors"].push_back(accessor); // 2: dense
    accessor["sparse"] = sparse(5, 5121, 6);
    this->json["accessors"].push_back(accessor); // 3: both
    accessor.erase("bufferView");
    accessor["sparse"] = sparse(3, 5125, 4);
    this->json["accessors"].push_back(accessor); // 4: sparse
    auto& meshes = this->json["meshes"];
    meshes[0]["name"] = "skin";
    meshes[0]["primitives"][0]["targets"] = {{{"POSITION", 2}}, {{"POSITION", 4}}};
    meshes[0]["extras"] = {{"targetNames", {"smile", "open"}}};
    meshes[1]["name"] = "teeth";
    meshes[1]["primitives"][0]["targets"] = {{{"POSITION", 3}}};
    meshes[1]["extras"] = {{"targetNames", {"open"}}};
  }
};

TEST(FaceScene, JoinsShapesOfAllPartsByTheirNames) {
  const FaceScene scene = parse_face_scene(ShapesGlb().bytes(), "face.glb");
  EXPECT_EQ(scene.face.names, (std::vector<std::string>{"smile", "open"}));
  Points smile(6, 3);
  smile << 2, 0, 0, 4, 0, 0, 6, 0, 0, // doubled by the node, not moved by it
      0, 0, 0, 0, 0, 0, 0, 0, 0;      // the second mesh has no such shape
  Points open(6, 3);
  open << 0, 0, 0, 0, 0, 0, 0, -2, 0, //
      0, 0, 8, 0, 4, 0, 0, 6, 0;      // turned by a quarter about z
  EXPECT_LT((scene.face.offsets.at(0) - smile).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((scene.face.offsets.at(1) - open).cwiseAbs().maxCoeff(), 1e-6);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[1].name, "teeth");
  EXPECT_EQ(scene.meshes[1].shapes, (std::vector<std::string>{"open"}));
  EXPECT_EQ(scene.meshes[1].vertices, 3);
  ASSERT_EQ(scene.nodes.size(), 2u);
  EXPECT_EQ(scene.nodes[1].parent, 0);
  EXPECT_EQ(scene.nodes[1].mesh, 1);
  const std::vector<double> extents = shape_extents(scene.face);
  EXPECT_NEAR(extents[0], 6.0, 1e-6);
  EXPECT_NEAR(extents[1], 8.0, 1e-6);
}

TEST(FaceScene, NamesShapesThatTheFileDoesNotName) {
  ShapesGlb glb;
  glb.json["meshes"][0].erase("extras");
  glb.json["meshes"][1]["extras"]["targetNames"] = {""};
  EXPECT_EQ(parse_face_scene(glb.bytes(), "face.glb").face.names,
            (std::vector<std::string>{"mesh0_target0", "mesh0_target1", "mesh1_target0"}));
}

TEST(FaceScene, RefusesShapesThatDoNotHoldTogether) {
  using Change = std::function<void(json&)>;
  const std::vector<std::pair<const char*, Change>> changes = {
      {"two morph targets of mesh \"skin\" have the name \"smile\"",
       [](auto& j) {
         j["meshes"][0]["extras"]["targetNames"] = {"smile", "smile"};
       }},
      {"mesh \"skin\" does not name each of its morph targets (expected 2 targetNames, got 3)",
       [](auto& j) {
         j["meshes"][0]["extras"]["targetNames"] = {"a", "b", "c"};
       }},
      {"reference to a accessor",
       [](auto& j) { j["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 12; }},
      {"offsets of morph target \"smile\" are not vectors",
       [](auto& j) { j["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 1; }},
      {"offsets of morph target \"smile\" are not one for each vertex",
       [](auto& j) { j["accessors"][2]["count"] = 2; }},
      {"reach past the end", [](auto& j) { j["bufferViews"][2]["byteOffset"] = 90; }},
      {"number of sparse offsets of morph target \"open\"",
       [](auto& j) { j["accessors"][4]["sparse"]["count"] = 4; }},
      {"number of sparse offsets of morph target \"open\"",
       [](auto& j) { j["accessors"][4]["sparse"]["count"] = -1; }},
      {"a vertex leads nowhere",
       [](auto& j) { j["accessors"][4]["sparse"]["indices"]["byteOffset"] = 8; }},
      {"reference to a buffer view",
       [](auto& j) { j["accessors"][4]["sparse"]["values"]["bufferView"] = 70; }},
      {"reach past the end",
       [](auto& j) { j["accessors"][4]["sparse"]["values"]["byteOffset"] = 28; }},
      {"reach past the end",
       [](auto& j) { j["accessors"][4]["sparse"]["values"]["byteOffset"] = -8000; }},
      {"parts of mesh \"skin\" differ in the number of their morph targets", [](auto& j) {
         j["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
       }}};
  for (const auto& [message, change] : changes) {
    ShapesGlb glb;
    change(glb.json);
    const std::string error = test::input_error([&] { parse_face_scene(glb.bytes(), "face.glb"); });
    EXPECT_TRUE(error.starts_with("face.glb: ")) << error;
    EXPECT_NE(error.find(message), std::string::npos)
        << "expected: " << message << "\ngot: " << error;
  }
}

// Any byte of the file may be anything: an error or a face, never more.
TEST(FaceScene, StandsDamagedFiles) {
  const std::string whole = ShapesGlb().bytes();
  std::mt19937 random(7);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = whole;
    for (int change = 0; change < 1 + trial % 3; ++change) {
      bytes[20 + random() % (bytes.size() - 20)] = static_cast<char>(random());
    }
    if (trial % 5 == 0) {
      bytes.resize(random() % bytes.size());
    }
    try {
      const FaceScene scene = parse_face_scene(bytes, "face.glb");
      for (const Points& offsets : scene.face.offsets) {
        ASSERT_EQ(offsets.rows(), scene.face.neutral.vertex_count());
        ASSERT_TRUE(offsets.allFinite());
      }
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(FaceScene, SaysThatAFaceHasNoShapes) {
  const test::TemporaryFolder folder;
  write_file(folder.path() / "still.glb", test::SmallGlb().bytes());
  std::string error = test::input_error([&] { read_shape_face(folder.path() / "still.glb"); });
  EXPECT_NE(error.find("still.glb: this face has no shapes of its own"), std::string::npos)
      << error;
  write_file(folder.path() / "mask.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  error = test::input_error([&] { read_shape_face(folder.path() / "mask.obj"); });
  EXPECT_NE(error.find("mask.obj: this face has no shapes of its own"), std::string::npos) << error;
  EXPECT_EQ(read_face_scene(folder.path() / "mask.obj").face.neutral.triangle_count(), 1);

  ShapesGlb still;
  still.json["meshes"].erase(1);
  still.json["nodes"][0].erase("children");
  still.json["nodes"].erase(1);
  for (auto& target : still.json["meshes"][0]["primitives"][0]["targets"]) {
    target = {{"NORMAL", 2}};
  }
  write_file(folder.path() / "still.glb", still.bytes());
  error = test::input_error([&] { read_shape_face(folder.path() / "still.glb"); });
  EXPECT_NE(error.find("none of this face's shapes moves anything"), std::string::npos) << error;
}

// ICT-FaceKit's shapes are stored sparsely, over eight parts; its first part is neutral_skin.obj.
TEST(FaceScene, ReadsARealFace) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const ShapeFace face = read_shape_face(data / "faces" / "ict");
  ASSERT_EQ(face.names.size(), 53u);
  EXPECT_EQ(face.neutral.parts.size(), 8u);
  const auto shape = [&](const char* name) {
    return face.offsets.at(
        static_cast<std::size_t>(std::ranges::find(face.names, name) - face.names.begin()));
  };
  // The jaw opens downwards; a left eye's blink leaves the right half alone (x > 0 is left).
  Eigen::Index lowest = 0;
  shape("jawOpen").col(1).minCoeff(&lowest);
  EXPECT_LT(shape("jawOpen")(lowest, 1), -0.005);
  EXPECT_GT(shape("jawOpen")(lowest, 1), -0.05);
  const Points blink = shape("eyeBlink_L");
  for (int v = 0; v < face.neutral.skin_vertex_count(); ++v) {
    if (face.neutral.positions(v, 0) < -0.01) {
      ASSERT_LT(blink.row(v).norm(), 1e-4) << v;
    }
  }
}

} // namespace
} // namespace phonomime
