// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "db/types/file_io.h"
#include "tests/db/import/readers/c3d_writer.h"
#include "tests/db/import/readers/textgrid_samples.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

class Detection : public ::testing::Test {
protected:
  std::filesystem::path file(const std::string& name, const std::string& bytes) const {
    write_file(folder_ / name, bytes);
    return folder_ / name;
  }

private:
  test::TemporaryFolder folder_;
};

TEST_F(Detection, AlignmentsBySuffixThenContent) {
  const std::string xlabel = "#\n0.25 100 pau\n0.5 100 b\n";
  const std::string htk = "0 2500000 pau\n2500000 5000000 b\n";
  const auto labels = [&](const std::string& name, const std::string& bytes) {
    const Alignment alignment = read_alignment(file(name, bytes));
    return alignment.rows.at(0).label + " " + alignment.rows.at(1).label;
  };
  EXPECT_EQ(labels("a.lab", xlabel), "pau b");
  EXPECT_EQ(labels("b.lab", htk), "pau b");
  EXPECT_EQ(labels("c.LAB", test::to_utf16(htk, false)), "pau b");
  EXPECT_EQ(labels("d.htk", htk), "pau b");
  EXPECT_EQ(labels("e", xlabel), "pau b");
  EXPECT_EQ(labels("f.txt", htk), "pau b");
  EXPECT_EQ(labels("g.TextGrid", test::kLongTextGrid), " ɡ\"o");
  EXPECT_EQ(labels("h.textgrid", test::to_utf16(test::kShortTextGrid, true)), " ɡ\"o");
  EXPECT_EQ(labels("i.txt", test::to_utf16(test::kShortTextGrid, true)), " ɡ\"o");
  AlignmentOptions words;
  words.tier = "words";
  EXPECT_EQ(read_alignment(file("j.TextGrid", test::kLongTextGrid), words).rows.size(), 1U);
  const char* unknown = "is in no known alignment format (expected Festival/xlabel (.lab), HTK";
  test::expect_error([&] { read_alignment(file("k.txt", "h# 0 100\n")); }, unknown);
  test::expect_error([&] { read_alignment(file("l.phn", htk)); }, unknown);
  test::expect_error([&] { read_alignment(file("m.lab", "pau b\n")); },
                     "the header of the xlabel file has no end");
  test::expect_error([&] { read_alignment(file("n.mlf", "#!MLF!#\n")); }, "master label files");
  test::expect_error([&] { read_alignment(file("o.lab", "#!MLF!#\n")); }, "master label files");
}

TEST_F(Detection, MotionBySuffixThenContent) {
  const std::string c3d = test::write_c3d({});
  const std::string markers = "time,a_x,a_y,a_z\n0,1,2,3\n1,1,2,3\n";
  const std::string take = "Timecode,BlendShapeCount,JawOpen\n01:00:00:00,1,0\n01:00:00:01,1,0\n";
  const auto channels = [&](const std::string& name, const std::string& bytes) {
    return read_motion(file(name, bytes)).frames.cols();
  };
  EXPECT_EQ(channels("a.c3d", c3d), 6);
  EXPECT_EQ(channels("b.C3D", c3d), 6);
  EXPECT_EQ(channels("c", c3d), 6);
  EXPECT_EQ(channels("d.csv", markers), 3);
  EXPECT_EQ(channels("e.CSV", take), 1);
  EXPECT_EQ(channels("f.txt", take), 1);
  EXPECT_EQ(channels("g.csv", test::to_utf16(markers, true)), 3);
  const auto refused = [&](const char* name, const std::string& bytes, const char* message) {
    test::expect_error([&] { read_motion(file(name, bytes)); }, message);
  };
  const char* unknown =
      "is in no known motion format (expected C3D (.c3d), a marker or weight table";
  refused("h.csv", "frame,a\n0,1\n", unknown);
  refused("i.bvh", "HIERARCHY\n", unknown);
  refused("j.dat", std::string(600, '\xFF'), unknown);
  refused("k.txt", "", unknown);
  refused("l.c3d", markers, "is not a C3D file");
  EXPECT_THROW(read_motion("no/such/file.c3d"), IoError);
  EXPECT_THROW(read_alignment("no/such/file.lab"), IoError);
}

} // namespace
} // namespace phonomime
