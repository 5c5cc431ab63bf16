// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/marker_map.h"

#include "tests/support/expect_error.h"
#include "tests/synth/retarget/made_mesh.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

const Layout kLayout = test::made_layout(
    {{"lm3", {}, ""}, {"lm10", {}, ""}, {"lm0", {}, ""}, {"lm7", {}, ""}, {"lm8", {}, ""}});

std::string error_of(std::string_view text) {
  return test::input_error([&] { parse_marker_map(text, "markers.tsv", kLayout, 20); });
}

TEST(MarkerMap, ReadsATableWithFurtherColumns) {
  const MarkerMap map =
      parse_marker_map("# made by hand\r\nnote\tmarker\tvertex\r\n\tlm0\t5\r\nx\tlm3\t4\r\n"
                       "\tlm10\t0\r\n\tlm7\t19\r\n\tother\t1\r\n",
                       "markers.tsv", kLayout, 20);
  EXPECT_EQ(map.vertices, (std::vector<int>{4, 0, 5, 19, -1}));
  EXPECT_EQ(map.missing, std::vector<std::string>{"lm8"});
  EXPECT_EQ(map.unknown, std::vector<std::string>{"other"});
  EXPECT_FALSE(map.automatic);
}

TEST(MarkerMap, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(error_of("marker\tvertex\nlm0\t20\n"),
            "markers.tsv:2: marker \"lm0\" is on a vertex that the face does not have (expected 0 "
            "to 19, got "
            "\"20\")");
  EXPECT_TRUE(error_of("marker\tvertex\nlm0\t-1\n").starts_with("markers.tsv:2: "));
  EXPECT_TRUE(error_of("marker\tvertex\nlm0\tfive\n").starts_with("markers.tsv:2: "));
  EXPECT_TRUE(error_of("marker\tvertex\nlm0\n").starts_with("markers.tsv:2: vertex is empty"));
  EXPECT_TRUE(error_of("marker\tnode\nlm0\t1\n")
                  .starts_with("markers.tsv:1: column \"vertex\" is missing"));
  EXPECT_TRUE(
      error_of("marker\tvertex\nlm0\t1\nlm3\t1\n").starts_with("markers.tsv:3: two markers"));
  EXPECT_TRUE(error_of("marker\tvertex\nlm0\t1\nlm0\t2\n")
                  .starts_with("markers.tsv:3: marker \"lm0\" is placed"));
  EXPECT_TRUE(
      error_of("marker\tvertex\nlm0\t1\n").starts_with("markers.tsv: the table places too few"));
  EXPECT_TRUE(error_of("").starts_with("markers.tsv: table has no header line"));
}

TEST(MarkerMap, TakesNumbersFromNames) {
  const auto map = marker_map_from_names(kLayout, 11);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->vertices, (std::vector<int>{3, 10, 0, 7, 8}));
  EXPECT_TRUE(map->automatic);
  EXPECT_FALSE(marker_map_from_names(kLayout, 10)) << "vertex 10 is out of range";
  const auto with = [](const char* name) {
    return test::made_layout(
        {{"lm3", {}, ""}, {"lm10", {}, ""}, {"lm0", {}, ""}, {"lm7", {}, ""}, {name, {}, ""}});
  };
  for (const char* name : {"chin", "lm", "x8", "lm07", "lm99999999999999999999"}) {
    EXPECT_FALSE(marker_map_from_names(with(name), 100)) << name;
  }
  EXPECT_TRUE(marker_map_from_names(with("lm9"), 100));
}

} // namespace
} // namespace phonomime
