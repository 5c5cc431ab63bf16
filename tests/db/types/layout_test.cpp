// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/layout.h"

#include "db/types/file_io.h"
#include "tests/support/expect_error.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

using nlohmann::json;
using test::input_error;

json good_layout() {
  return json::parse(R"({"format": "phonomime-layout", "version": 1, "kind": "markers",
    "unit": "cm", "axes": {"x": "left of the picture", "y": "away from the camera", "z": "up"},
    "reference": "a",
    "groups": [{"name": "a", "regions": ["nose", "rigid"]}, {"name": "b", "regions": ["lips"]},
               {"name": "c"}],
    "landmarks": {"lip_upper_inner": "b"}})");
}

Layout parsed(const json& layout) {
  return parse_layout(layout.dump(), "layout.json");
}

std::string layout_error(const json& layout) {
  return input_error([&] { parsed(layout); });
}

TEST(Layout, SaysWhereEachOfOurAxesComesFrom) {
  const Layout layout = parsed(good_layout());
  EXPECT_EQ(layout.unit_mm, 10.0);
  EXPECT_EQ(layout.axes[0].axis, 0); // right of the picture = minus the file's x
  EXPECT_EQ(layout.axes[0].sign, -1.0);
  EXPECT_EQ(layout.axes[1].axis, 2); // up = the file's z
  EXPECT_EQ(layout.axes[1].sign, 1.0);
  EXPECT_EQ(layout.axes[2].axis, 1); // towards the camera = minus the file's y
  EXPECT_EQ(layout.axes[2].sign, -1.0);
}

TEST(Layout, AcceptsExactlyTheCombinationsThatSpanSpace) {
  const std::vector<std::string> words = {
      "right of the picture", "left of the picture", "up", "down",
      "towards the camera",   "away from the camera"};
  int accepted = 0;
  for (std::size_t x = 0; x < 6; ++x) {
    for (std::size_t y = 0; y < 6; ++y) {
      for (std::size_t z = 0; z < 6; ++z) {
        json layout = good_layout();
        layout["axes"] = {{"x", words[x]}, {"y", words[y]}, {"z", words[z]}};
        const bool spans = std::set<std::size_t>{x / 2, y / 2, z / 2}.size() == 3;
        if (!spans) {
          EXPECT_THROW(parsed(layout), InputError);
          continue;
        }
        const Layout result = parsed(layout);
        const std::size_t source[] = {x, y, z};
        for (std::size_t ours = 0; ours < 3; ++ours) {
          const std::size_t word = source[static_cast<std::size_t>(result.axes[ours].axis)];
          EXPECT_EQ(word / 2, ours);
          EXPECT_EQ(result.axes[ours].sign, word % 2 == 0 ? 1.0 : -1.0);
        }
        ++accepted;
      }
    }
  }
  EXPECT_EQ(accepted, 48);
}

TEST(Layout, FindsGroupsRegionsAndLandmarks) {
  const Layout layout = parsed(good_layout());
  EXPECT_EQ(layout.channel_count(), 9);
  EXPECT_EQ(layout.find_group("b"), 1);
  EXPECT_EQ(layout.find_group("d"), std::nullopt);
  EXPECT_EQ(layout.find_landmark("lip_upper_inner"), 1);
  EXPECT_EQ(layout.find_landmark("chin"), std::nullopt);
  EXPECT_EQ(layout.groups_in(Region::rigid), std::vector<int>{0});
  EXPECT_EQ(layout.groups_in(Region::jaw), std::vector<int>{});
  EXPECT_TRUE(layout.groups[2].regions.empty());
}

TEST(Layout, SaysWhetherItsScaleCanBeBelieved) {
  json layout = good_layout();
  EXPECT_EQ(parsed(layout).scale, std::nullopt);
  for (const Scale scale : {Scale::measured, Scale::nominal}) {
    layout["scale"] = kScaleNames[static_cast<std::size_t>(scale)];
    EXPECT_EQ(parsed(layout).scale, scale);
    EXPECT_EQ(parse_layout(format_layout(parsed(layout)), "database").scale, scale);
  }
  layout["scale"] = "guessed";
  EXPECT_NE(layout_error(layout).find("$.scale"), std::string::npos);
}

TEST(Layout, IsReadBackInMillimetresAndOurAxes) {
  const Layout layout = parsed(good_layout());
  const Layout again = parse_layout(format_layout(layout), "database");
  EXPECT_EQ(again.unit_mm, 1.0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(again.axes[static_cast<std::size_t>(i)].axis, i);
    EXPECT_EQ(again.axes[static_cast<std::size_t>(i)].sign, 1.0);
  }
  EXPECT_EQ(again.reference, layout.reference);
  EXPECT_EQ(again.landmarks, layout.landmarks);
  ASSERT_EQ(again.group_count(), layout.group_count());
  for (std::size_t i = 0; i < layout.groups.size(); ++i) {
    EXPECT_EQ(again.groups[i].name, layout.groups[i].name);
    EXPECT_EQ(again.groups[i].regions, layout.groups[i].regions);
  }
  EXPECT_EQ(format_layout(again), format_layout(layout));
}

TEST(Layout, OfWeightsIsPlain) {
  json layout = {{"format", "phonomime-layout"},
                 {"version", 1},
                 {"kind", "weights"},
                 {"groups", {{{"name", "JawOpen"}, {"regions", {"jaw"}}}}}};
  EXPECT_EQ(parsed(layout).channel_count(), 1);
  EXPECT_EQ(parse_layout(format_layout(parsed(layout)), "x").kind, LayoutKind::weights);
  for (const char* member : {"unit", "axes", "reference", "landmarks"}) {
    json wrong = layout;
    wrong[member] = good_layout()[member];
    EXPECT_EQ(layout_error(wrong), std::string("layout.json: a layout of weights has no \"") +
                                       member + "\". Remove it, or set \"kind\" to \"markers\".");
  }
}

TEST(Layout, EachFaultIsNamed) {
  json layout = good_layout();
  layout.erase("unit");
  EXPECT_NE(layout_error(layout).find("a layout of markers needs \"unit\""), std::string::npos);
  layout = good_layout();
  layout["unit"] = "inch";
  EXPECT_NE(
      layout_error(layout).find("$.unit has an unknown value (expected \"mm\", \"cm\", \"m\", "
                                "got \"inch\")"),
      std::string::npos);
  layout = good_layout();
  layout["axes"]["y"] = "right of the picture";
  EXPECT_NE(layout_error(layout).find("$.axes: x and y lie along the same direction"),
            std::string::npos);
  layout = good_layout();
  layout["reference"] = "d";
  EXPECT_NE(layout_error(layout).find("$.reference: there is no group \"d\""), std::string::npos);
  layout = good_layout();
  layout["landmarks"]["chin"] = "B";
  EXPECT_NE(
      layout_error(layout).find("$.landmarks.chin: there is no group \"B\". Did you mean \"b\"?"),
      std::string::npos);
  layout = good_layout();
  layout["groups"][2]["name"] = "a";
  EXPECT_NE(layout_error(layout).find("$.groups[2].name: there are two groups \"a\""),
            std::string::npos);
  layout = good_layout();
  layout["groups"][0]["regions"] = {"lip"};
  EXPECT_NE(layout_error(layout).find("$.groups[0].regions[0] has an unknown value"),
            std::string::npos);
  for (const char* name : {"", " a", "a ", "a,b", "a\"b", "a\nb", "a\tb"}) {
    layout = good_layout();
    layout["groups"][2]["name"] = name;
    EXPECT_NE(layout_error(layout).find("$.groups[2].name"), std::string::npos) << name;
  }
  layout = good_layout();
  layout["groups"] = json::array();
  EXPECT_NE(layout_error(layout).find("$.groups"), std::string::npos);
}

TEST(Layout, OfTheGridRecordings) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const std::filesystem::path file = data / "grid_s1" / "layout.json";
  const Layout layout = parse_layout(read_file(file), file.string());
  EXPECT_EQ(layout.group_count(), 91);
  EXPECT_EQ(layout.channel_count(), 273);
  EXPECT_EQ(layout.unit_mm, 1.0);
  EXPECT_EQ(layout.reference, "lm168");
  EXPECT_EQ(layout.groups_in(Region::lips).size(), 40u);
  ASSERT_TRUE(layout.find_landmark("lip_lower_inner"));
  EXPECT_EQ(layout.groups[static_cast<std::size_t>(*layout.find_landmark("lip_lower_inner"))].name,
            "lm14");
}

} // namespace
} // namespace phonomime
