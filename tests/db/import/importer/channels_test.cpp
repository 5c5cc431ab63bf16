// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/channels.h"

#include "db/types/errors.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// The file's axes: x to the left of the picture, y towards the camera, z up; centimetres.
Layout camera_layout() {
  Layout layout;
  layout.unit_mm = 10.0;
  layout.axes = {{{0, -1.0}, {2, 1.0}, {1, 1.0}}};
  layout.groups = {{"a", {}}, {"b", {}}};
  return layout;
}

MotionClip clip(std::vector<std::string> groups) {
  MotionClip motion;
  motion.rate_hz = 30.0;
  motion.groups = std::move(groups);
  motion.frames.resize(2, static_cast<Eigen::Index>(3 * motion.groups.size()));
  for (Eigen::Index i = 0; i < motion.frames.size(); ++i) {
    motion.frames.data()[i] = static_cast<float>(i + 1);
  }
  return motion;
}

TEST(Channels, AreFoundByNameInAnyOrderAndTurnedIntoOurAxes) {
  const LayoutMotion motion = to_layout(clip({"b", "extra", "a"}), camera_layout(), "x.c3d");
  EXPECT_EQ(motion.extra_groups, std::vector<std::string>{"extra"});
  EXPECT_EQ(motion.rate_hz, 30.0);
  // Frame 0 is b = (1, 2, 3), extra = (4, 5, 6), a = (7, 8, 9) in the file.
  const Eigen::RowVectorXd first{{-70, 90, 80, -10, 30, 20}};
  EXPECT_EQ(motion.frames.row(0), first);
}

TEST(Channels, WeightsKeepTheirValues) {
  Layout layout;
  layout.kind = LayoutKind::weights;
  layout.groups = {{"JawOpen", {}}, {"MouthClose", {}}};
  MotionClip motion;
  motion.rate_hz = 60.0;
  motion.channels_per_group = 1;
  motion.groups = {"MouthClose", "JawOpen"};
  motion.frames.resize(1, 2);
  motion.frames << 0.25f, 0.5f;
  EXPECT_EQ(to_layout(motion, layout, "t.csv").frames,
            (FrameMatrixD(1, 2) << 0.5, 0.25).finished());
  EXPECT_THROW(to_layout(motion, camera_layout(), "t.csv"), InputError);
}

TEST(Channels, WhatDoesNotFitIsSaid) {
  const auto message = [](const MotionClip& motion) -> std::string {
    try {
      to_layout(motion, camera_layout(), "x.c3d");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(clip({"a", "bb"})),
            "x.c3d: recording lacks 1 of the layout's 2 groups: \"b\". Did you mean \"bb\"?");
  EXPECT_NE(message(clip({"a", "b", "a"})).find("group \"a\" twice"), std::string::npos);
  MotionClip millimetres = clip({"a", "b"});
  millimetres.unit_mm = 1.0;
  EXPECT_EQ(message(millimetres), "x.c3d: recording is in another unit than the layout says "
                                  "(expected cm, got mm). Correct `unit` in the layout.");
  MotionClip empty = clip({"a", "b"});
  empty.frames.resize(0, 6);
  EXPECT_NE(message(empty).find("no frames"), std::string::npos);
  MotionClip still = clip({"a", "b"});
  still.rate_hz = 0.0;
  EXPECT_NE(message(still).find("no frame rate"), std::string::npos);
}

} // namespace
} // namespace phonomime
