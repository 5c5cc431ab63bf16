// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/lip_measures.h"

#include "db/types/errors.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

Layout mouth() {
  Layout layout;
  layout.groups = {{"chin", {Region::jaw}},   {"up", {Region::lips}},   {"low", {Region::lips}},
                   {"right", {Region::lips}}, {"left", {Region::lips}}, {"nose", {Region::nose}}};
  layout.landmarks = {{"lip_upper_inner", "up"},
                      {"lip_lower_inner", "low"},
                      {"mouth_corner_right", "right"},
                      {"mouth_corner_left", "left"}};
  return layout;
}

const std::vector<double> kFrame = {0,   -50, 7,  // chin
                                    1,   3,   10, // up
                                    2,   -4,  12, // low
                                    -20, 0,   5,  // right
                                    20,  9,   17, // left
                                    0,   40,  30};

TEST(LipMeasures, MeasuresTheLandmarks) {
  const LipMeasures lips(mouth());
  EXPECT_DOUBLE_EQ(lips.aperture_mm(kFrame).value(), 7.0); // upwards alone
  EXPECT_DOUBLE_EQ(lips.width_mm(kFrame).value(), std::sqrt(40.0 * 40 + 9 * 9 + 12 * 12));
  EXPECT_DOUBLE_EQ(lips.protrusion_mm(kFrame).value(), 11.0); // mean z of four
}

TEST(LipMeasures, CallsOverlappingLipsClosed) {
  std::vector<double> frame = kFrame;
  frame[4] = -6.0;
  EXPECT_LT(LipMeasures(mouth()).aperture_mm(frame).value(), kClosedAperture_mm);
}

TEST(LipMeasures, SaysNothingWhereTheLayoutCannot) {
  Layout layout = mouth();
  layout.landmarks.erase("lip_lower_inner");
  layout.landmarks.erase("mouth_corner_left");
  for (ChannelGroup& group : layout.groups) {
    group.regions.clear();
  }
  const LipMeasures without(layout);
  EXPECT_EQ(without.aperture_mm(kFrame), std::nullopt);
  EXPECT_EQ(without.width_mm(kFrame), std::nullopt);
  EXPECT_EQ(without.protrusion_mm(kFrame), std::nullopt);

  layout = mouth();
  layout.kind = LayoutKind::weights;
  const LipMeasures weights(layout);
  const std::vector<double> frame(6, 0.5);
  EXPECT_EQ(weights.aperture_mm(frame), std::nullopt);
  EXPECT_EQ(weights.width_mm(frame), std::nullopt);
  EXPECT_EQ(weights.protrusion_mm(frame), std::nullopt);
}

TEST(LipMeasures, RefusesAFrameOfAnotherLayout) {
  const LipMeasures lips(mouth());
  EXPECT_THROW(lips.aperture_mm(std::vector<double>(17)), InternalError);
  EXPECT_THROW(lips.width_mm(std::vector<double>(19)), InternalError);
  EXPECT_THROW(lips.protrusion_mm({}), InternalError);
}

} // namespace
} // namespace phonomime
