// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/face_source.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/synth/retarget/glb_bytes.h"
#include "tests/synth/retarget/made_mesh.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr const char* kObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nf 1 2 3\nf 2 4 3\nf 2 5 4\n";

class FaceSourceTest : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("face_source_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
               "_" + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void put(const char* name, std::string_view bytes) const { write_file(folder_ / name, bytes); }

  std::string error_of(const std::filesystem::path& path) const {
    try {
      read_face(path, layout_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
  Layout layout_ =
      test::made_layout({{"m0", {}, ""}, {"m1", {}, ""}, {"m2", {}, ""}, {"m3", {}, ""}});
};

TEST_F(FaceSourceTest, PlacesMarkersByTheTableElseByTheirNames) {
  put("face.obj", kObj);
  EXPECT_TRUE(read_face(folder_, layout_).markers.automatic);
  EXPECT_EQ(read_face(folder_ / "face.obj", layout_).markers.vertices,
            (std::vector<int>{0, 1, 2, 3}));
  put("markers.tsv", "marker\tvertex\nm0\t4\nm1\t1\nm2\t2\nm3\t3\n");
  EXPECT_EQ(read_face(folder_, layout_).markers.vertices, (std::vector<int>{4, 1, 2, 3}));
  EXPECT_EQ(read_face(folder_ / "face.obj", layout_).markers.vertices,
            (std::vector<int>{4, 1, 2, 3}));
}

TEST_F(FaceSourceTest, PrefersTheGlbOfAFolder) {
  put("face.obj", kObj);
  put("head.glb", test::SmallGlb().bytes());
  put("markers.tsv", "marker\tvertex\nm0\t0\nm1\t1\nm2\t2\nm3\t3\n");
  EXPECT_NE(error_of(folder_).find("does not have"), std::string::npos)
      << "its skin has 3 vertices";
  EXPECT_EQ(error_of(folder_ / "face.obj"), "no error");
}

TEST_F(FaceSourceTest, SaysWhatIsMissing) {
  EXPECT_NE(error_of(folder_).find("there is no face in this folder"), std::string::npos);
  EXPECT_THROW(read_face(folder_ / "none.obj", layout_), IoError);
  put("a.obj", kObj);
  layout_.groups.back().name = "chin";
  EXPECT_NE(error_of(folder_).find("nothing says where the markers sit"), std::string::npos);
  put("b.obj", kObj);
  EXPECT_NE(error_of(folder_).find("several .obj files (expected one, got a.obj, b.obj)"),
            std::string::npos);
  put("c.ply", "ply");
  EXPECT_NE(error_of(folder_ / "c.ply").find("not a mesh"), std::string::npos);
  layout_.kind = LayoutKind::weights;
  EXPECT_NE(error_of(folder_ / "a.obj").find("needs a database of markers"), std::string::npos);
}

} // namespace
} // namespace phonomime
