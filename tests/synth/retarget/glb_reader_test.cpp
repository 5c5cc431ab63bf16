// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mesh_reader.h"

#include "db/types/errors.h"
#include "tests/support/expect_error.h"
#include "tests/synth/retarget/glb_bytes.h"

#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::SmallGlb;

std::string error_of(const std::string& bytes) {
  return test::input_error([&] { parse_glb(bytes, "face.glb"); });
}

TEST(GlbReader, ReadsPartsWithTheirNodesTransformsAndMaterials) {
  const TriangleMesh mesh = parse_glb(SmallGlb().bytes(), "face.glb");
  ASSERT_EQ(mesh.parts.size(), 2u);
  Points expected(6, 3);
  expected << 10, 0, 0, 12, 0, 0, 10, 2, 0, // moved and doubled
      10, 0, 0, 10, 2, 0, 8, 0, 0;          // and turned by a quarter
  EXPECT_LT((mesh.positions - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(mesh.triangles.row(1), Eigen::RowVector3i(3, 4, 5));
  EXPECT_EQ(mesh.parts[0].material, 0);
  EXPECT_EQ(mesh.parts[1].material, -1);
  EXPECT_EQ(mesh.parts[1].first_vertex, 3);
  ASSERT_EQ(mesh.materials.size(), 1u);
  EXPECT_EQ(mesh.materials[0].base_color, (std::array<double, 4>{1, 0.5, 0.25, 1}));
  EXPECT_EQ(mesh.materials[0].roughness, 0.75);
  EXPECT_TRUE(mesh.materials[0].double_sided);
}

TEST(GlbReader, RefusesWhatDoesNotHoldTogether) {
  using Change = std::function<void(nlohmann::json&)>;
  const std::vector<std::pair<const char*, Change>> changes = {
      {"positions reach past the end", [](auto& j) { j["accessors"][0]["count"] = 4; }},
      {"number or the layout of the positions",
       [](auto& j) { j["accessors"][0]["count"] = 4000000000u; }},
      {"positions reach past the end",
       [](auto& j) { j["accessors"][0]["byteOffset"] = 4000000000u; }},
      {"positions reach past the end", [](auto& j) { j["bufferViews"][0]["byteOffset"] = 44; }},
      {"reference to a buffer view", [](auto& j) { j["accessors"][0]["bufferView"] = 7; }},
      {"accessor out of bounds", [](auto& j) { j["meshes"][0]["primitives"][0]["indices"] = 9; }},
      {"indices have another type",
       [](auto& j) { j["meshes"][0]["primitives"][0]["indices"] = 0; }},
      {"reference to a material", [](auto& j) { j["meshes"][0]["primitives"][0]["material"] = 3; }},
      {"reference to a mesh", [](auto& j) { j["nodes"][0]["mesh"] = 5; }},
      {"nodes are not a tree", [](auto& j) { j["nodes"][1]["children"] = {0}; }},
      {"reference to a node", [](auto& j) { j["nodes"][0]["children"] = {12}; }},
      {"reference to a scene", [](auto& j) { j["scene"] = 4; }},
      {"stored sparsely", [](auto& j) { j["accessors"][0].erase("bufferView"); }},
      {"not made of single triangles",
       [](auto& j) { j["meshes"][0]["primitives"][0]["mode"] = 1; }},
      {"extension",
       [](auto& j) {
         j["extensionsUsed"] = j["extensionsRequired"] = {"KHR_draco_mesh_compression"};
       }},
      {"no mesh in this file's scene",
       [](auto& j) { j["scenes"][0]["nodes"] = nlohmann::json::array(); }}};
  for (const auto& [message, change] : changes) {
    SmallGlb glb;
    change(glb.json);
    const std::string error = error_of(glb.bytes());
    EXPECT_TRUE(error.starts_with("face.glb: ")) << error;
    EXPECT_NE(error.find(message), std::string::npos)
        << "expected: " << message << "\ngot: " << error;
  }
}

TEST(GlbReader, RefusesIndicesOutOfRangeAndBadNumbers) {
  SmallGlb indices;
  indices.binary[40] = 3;
  EXPECT_NE(error_of(indices.bytes()).find("reference to a vertex leads nowhere"),
            std::string::npos);
  SmallGlb numbers;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(numbers.binary.data() + 12, &nan, sizeof nan);
  EXPECT_NE(error_of(numbers.bytes()).find("position 1 is not a usable number"), std::string::npos);
}

TEST(GlbReader, RefusesOtherFiles) {
  EXPECT_NE(error_of("").find("not a binary glTF"), std::string::npos);
  EXPECT_NE(error_of("glTF").find("not a binary glTF"), std::string::npos);
  EXPECT_NE(error_of(std::string(5000, 'x')).find("not a binary glTF"), std::string::npos);
  const std::string good = SmallGlb().bytes();
  for (std::size_t length = 0; length < good.size(); length += 13) {
    EXPECT_NE(error_of(good.substr(0, length)), "") << length;
  }
}

TEST(GlbReader, SurvivesDamage) {
  const std::string good = SmallGlb().bytes();
  std::mt19937 random(11);
  for (int i = 0; i < 4000; ++i) {
    std::string bad = good;
    for (int k = 0; k < 1 + i % 4; ++k) {
      bad[random() % bad.size()] =
          static_cast<char>(i % 2 == 0 ? random() % 256 : '0' + random() % 10);
    }
    try {
      const TriangleMesh mesh = parse_glb(bad, "bad.glb");
      EXPECT_TRUE(mesh.positions.allFinite());
      if (mesh.triangle_count() > 0) {
        EXPECT_LT(mesh.triangles.maxCoeff(), mesh.vertex_count());
      }
    } catch (const InputError&) {
    }
  }
}

} // namespace
} // namespace phonomime
