// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/shape_names.h"

#include "db/types/live_link_columns.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

std::string meant(std::string_view name) {
  const std::optional<std::size_t> shape = arkit_shape(name);
  return shape ? std::string(kLiveLinkColumns[*shape]) : "none";
}

TEST(ShapeNames, MeansArkitsInAnySpelling) {
  for (std::size_t i = 0; i < kArkitShapeCount; ++i) {
    EXPECT_EQ(arkit_shape(kLiveLinkColumns[i]), i);
  }
  EXPECT_EQ(meant("browDown_L"), "BrowDownLeft");
  EXPECT_EQ(meant("eyeBlinkRight"), "EyeBlinkRight");
  EXPECT_EQ(meant("mouth_smile_left"), "MouthSmileLeft");
  EXPECT_EQ(meant("jawRight"), "JawRight");
  EXPECT_EQ(meant("browInnerUp_L"), "BrowInnerUp");
  EXPECT_EQ(meant("cheekPuff_R"), "CheekPuff");
  EXPECT_EQ(meant("mouthFunnel"), "MouthFunnel");
}

TEST(ShapeNames, AreNotGuessed) {
  for (const char* name :
       {"", "_L", "jawOpened", "smile", "HeadYaw", "Left", "eyeBlink", "mouthSmile"}) {
    EXPECT_EQ(meant(name), "none") << name;
  }
}

TEST(ShapeNames, MatchTheNearestSpellingFirst) {
  using Found = std::vector<std::size_t>;
  const std::vector<std::string> targets = {
      "BrowInnerUp_L", "browInnerUp_R", "jawopen", "jaw_open", "JawOpen", "Tail", "mouthSmile_L"};
  EXPECT_EQ(matching_shapes("JawOpen", targets), (Found{4}));
  EXPECT_EQ(matching_shapes("JAWOPEN", targets), (Found{2, 3, 4}));
  EXPECT_EQ(matching_shapes("BrowInnerUp", targets), (Found{0, 1}));
  EXPECT_EQ(matching_shapes("browInnerUp_L", targets), (Found{0}));
  EXPECT_EQ(matching_shapes("MouthSmileLeft", targets), (Found{6}));
  EXPECT_EQ(matching_shapes("tail", targets), (Found{5}));
  EXPECT_EQ(matching_shapes("TongueOut", targets), (Found{}));
}

} // namespace
} // namespace phonomime
