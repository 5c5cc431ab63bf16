// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mesh_reader.h"

#include "db/types/errors.h"
#include "tests/support/expect_error.h"

#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\n";

std::string error_of(std::string_view text) {
  return test::input_error([&] { parse_obj(text, "face.obj"); });
}

TEST(ObjReader, ReadsEveryWayToWriteACorner) {
  const TriangleMesh mesh =
      parse_obj(std::string("# a comment\nmtllib x.mtl\r\no head\n") + kSquare +
                    "vt 0 0\nvn 0 0 1\ng skin\nusemtl m\n"
                    "f 1 2 3\nf 1/1 3/1 4/1\nf 1//1 2//1 4//1 # end\n"
                    "f 2/1/1 3/1/1 4/1/1\nf -4 -3 -1\n",
                "face.obj");
  ASSERT_EQ(mesh.vertex_count(), 4);
  EXPECT_EQ(mesh.positions(3, 2), 0.5);
  Triangles expected(5, 3);
  expected << 0, 1, 2, 0, 2, 3, 0, 1, 3, 1, 2, 3, 0, 1, 3;
  EXPECT_EQ(mesh.triangles, expected);
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.skin_vertex_count(), 4);
}

TEST(ObjReader, SplitsPolygonsIntoFansWithoutDegenerateTriangles) {
  const TriangleMesh mesh =
      parse_obj(std::string(kSquare) + "f 1 2 3 4\nf 1 2 2 3\nf 1 1 1\n", "face.obj");
  Triangles expected(3, 3);
  expected << 0, 1, 2, 0, 2, 3, 0, 1, 2;
  EXPECT_EQ(mesh.triangles, expected);
}

TEST(ObjReader, SaysWhatIsWrongAndWhere) {
  const std::string square = kSquare;
  EXPECT_EQ(error_of(square + "f 1 2 9\n"),
            "face.obj:5: a face names a vertex that does not exist (expected 1 to 4, got 9)");
  EXPECT_EQ(error_of("v 1 2\n"),
            "face.obj:1: a vertex needs three coordinates (expected v X Y Z, got 2 "
            "coordinates)");
  for (const char* face : {"f 0 1 2", "f a b c", "f 1 2", "f -5 1 2", "f 1 2 99999999999999999999",
                           "f /1 2 3", "f 1 2 -9223372036854775808"}) {
    EXPECT_TRUE(error_of(square + face).starts_with("face.obj:5: ")) << error_of(square + face);
  }
  for (const char* vertex : {"v nan 0 0", "v inf 0 0", "v 1e300 0 0", "v x 0 0"}) {
    EXPECT_TRUE(error_of(vertex).starts_with("face.obj:1: a coordinate")) << vertex;
  }
  EXPECT_TRUE(error_of("").starts_with("face.obj: there is no triangle"));
  EXPECT_TRUE(error_of(square).starts_with("face.obj: there is no triangle"));
}

TEST(ObjReader, SurvivesDamage) {
  const std::string good = std::string(kSquare) + "f 1/1/1 2//2 3/3\nf -1 -2 -3\n";
  std::mt19937 random(7);
  for (int i = 0; i < 3000; ++i) {
    std::string bad = good;
    for (int k = 0; k < 3; ++k) {
      bad[random() % bad.size()] = static_cast<char>(random() % 256);
    }
    bad.resize(random() % (bad.size() + 1));
    try {
      const TriangleMesh mesh = parse_obj(bad, "bad.obj");
      EXPECT_GE(mesh.triangles.minCoeff(), 0);
      EXPECT_LT(mesh.triangles.maxCoeff(), mesh.vertex_count());
    } catch (const InputError&) {
    }
  }
}

} // namespace
} // namespace phonomime
