// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/demo/support.h"
#include "tools/demo/c3d_writer.h"
#include "tools/demo/marker_layout.h"
#include "tools/demo/random.h"

namespace phonomime::demo {
namespace {

std::vector<MarkerPose> random_frames(int count) {
  Random random(3);
  std::vector<MarkerPose> frames;
  for (int k = 0; k < count; ++k) {
    MarkerPose frame(static_cast<Eigen::Index>(marker_vertices().size()), 3);
    for (Eigen::Index i = 0; i < frame.size(); ++i)
      frame.data()[i] = random.uniform(-320.0, 320.0);
    frames.push_back(frame);
  }
  frames[1].row(4).setConstant(std::numeric_limits<double>::quiet_NaN());
  return frames;
}

void expect_read_back(C3dNumbers numbers) {
  if (!has_program("python3"))
    GTEST_SKIP() << "python3 is not installed";
  const test::TemporaryFolder folder;
  const std::vector<MarkerPose> frames = random_frames(7);
  write_file(folder.path() / "a.c3d", format_c3d(frames, 120.0, numbers));
  const ReadC3d c3d = read_with_python(folder.path() / "a.c3d");
  ASSERT_EQ(c3d.rate_hz, 120.0);
  ASSERT_EQ(c3d.frames, 7);
  ASSERT_EQ(c3d.markers, 91);
  ASSERT_EQ(c3d.points.size(), 7u * 91u);
  for (std::size_t i = 0; i < c3d.points.size(); ++i) {
    const ReadPoint& point = c3d.points[i];
    const auto marker = static_cast<Eigen::Index>(i % 91);
    ASSERT_EQ(point.name, marker_name(marker_vertices()[i % 91]));
    if (i == 91 + 4) {
      EXPECT_EQ(point.residual, -1.0);
      continue;
    }
    EXPECT_EQ(point.residual, 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double value = frames[i / 91](marker, axis);
      const double stored = numbers == C3dNumbers::floats
                                ? static_cast<float>(value)
                                : std::round(value / kC3dStep_mm) * kC3dStep_mm;
      EXPECT_NEAR(point.xyz_mm[axis], stored, 1e-9);
    }
  }
}

TEST(C3d, IndependentReaderGetsScaledIntegersBack) {
  expect_read_back(C3dNumbers::scaled_integers);
}

TEST(C3d, IndependentReaderGetsFloatsBack) {
  expect_read_back(C3dNumbers::floats);
}

TEST(C3d, RefusesWhatSixteenBitsCannotHold) {
  std::vector<MarkerPose> frames = random_frames(2);
  frames[0](0, 0) = 328.0;
  EXPECT_THROW(format_c3d(frames, 120.0, C3dNumbers::scaled_integers), InternalError);
  EXPECT_NO_THROW(format_c3d(frames, 120.0, C3dNumbers::floats));
  EXPECT_THROW(format_c3d({}, 120.0, C3dNumbers::floats), InternalError);
}

} // namespace
} // namespace phonomime::demo
