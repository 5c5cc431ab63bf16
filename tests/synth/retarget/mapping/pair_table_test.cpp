// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/file_io.h"
#include "synth/retarget/mapping/pair_table.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

const std::vector<std::string> kShapes = {"browDown_L", "jawOpen", "mouthSmile_L"};

void expect_refused(const std::string& text, const std::string& part) {
  expect_error([&] { parse_pair_table(text, "pairs.tsv", kShapes); }, part);
}

} // namespace

TEST(PairTable, ReadsTheExampleOfItsPage) {
  const std::string page =
      read_file(std::filesystem::path(PHONOMIME_SOURCE_DIR) / "corpora_schema/pairs.md");
  const std::size_t first = page.find("```tsv\n") + 7;
  const PairTable table =
      parse_pair_table(page.substr(first, page.find("```", first) - first), "pairs.md", kShapes);
  EXPECT_EQ(table.shapes, (std::vector<std::string>{"jawOpen", "mouthSmile_L"}));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[1].frame.node, "ann/happiness/s004#2");
  EXPECT_EQ(table.rows[1].frame.time_s, 0.05);
  EXPECT_EQ(table.rows[1].note, "AA happiness");
  EXPECT_EQ(table.weights, (FrameMatrixD(3, 2) << 0, 0, 0.55, 0.4, 0, 0.8).finished());
}

TEST(PairTable, IsWrittenAsItIsRead) {
  PairTable table;
  table.shapes = {"jawOpen", "mouthSmile_L"};
  table.rows.resize(2);
  table.rows[0].frame = {.node = "ann/neutral/s1#5", .time_s = 0.04};
  table.rows[0].note = "extreme";
  table.rows[1].frame = {.node = "ann/neutral/s1#6", .time_s = 0.0};
  table.weights = (FrameMatrixD(2, 2) << 0.25, 0, 1, 0.0625).finished();
  const PairTable again = parse_pair_table(format_pair_table(table), "pairs.tsv", kShapes);
  EXPECT_EQ(again.shapes, table.shapes);
  EXPECT_EQ(again.weights, table.weights);
  ASSERT_EQ(again.rows.size(), 2U);
  EXPECT_EQ(again.rows[0].frame.text(), "ann/neutral/s1#5@0.040");
  EXPECT_EQ(again.rows[0].note, "extreme");
  EXPECT_EQ(again.rows[1].line, 3);
}

TEST(PairTable, RefusesWhatItCannotTake) {
  expect_refused("frame\tjawOpn\nann/neutral/s1#5@0\t1\n",
                 "pairs.tsv:1: unknown column \"jawOpn\" (expected frame, note, browDown_L");
  expect_refused("frame\tjawOpen\tjawOpen\n", "pairs.tsv:1: column \"jawOpen\" is there twice");
  expect_refused("note\tjawOpen\n", "column \"frame\" is missing");
  expect_refused("frame\tjawOpen\nann/neutral/s1#5@0\t0.5\nann/neutral/s1#6@0\t1.5\n",
                 "pairs.tsv:3: the weight of \"jawOpen\" is out of range (expected a number from 0 "
                 "to 1, got \"1.5\")");
  expect_refused("frame\tjawOpen\nann/neutral/s1#5@0\tnan\n", "is out of range");
  expect_refused("frame\tjawOpen\nann/neutral/s1#5\t1\n",
                 "pairs.tsv:2: \"ann/neutral/s1#5\" does not name a frame");
  expect_refused("frame\tjawOpen\na#5@0\t1\na#5@0.0\t1\n",
                 "pairs.tsv:3: frame \"a#5@0.000\" is there");
  expect_refused("frame\tjawOpen\na#5@0\t1\t1\n", "more fields than the header");
  expect_refused("# nothing\nframe\tjawOpen\n", "the table holds no pairs");
}

} // namespace phonomime::test
