// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "db/types/live_link_columns.h"
#include "tests/support/expect_error.h"
#include "tests/support/shared_data.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

struct Case {
  std::string text;
  const char* message;
};

constexpr const char* kTwoValues = "Timecode,BlendShapeCount,JawOpen,HeadYaw\n";

std::string timecode(double time_s, double ticks_per_second = 60.0, int digits = 3) {
  const double day_s = std::fmod(time_s, 86400.0);
  const int whole = static_cast<int>(day_s + 1e-9);
  return fmt::format("{:02}:{:02}:{:02}:{:06.{}f}", whole / 3600, whole / 60 % 60, whole % 60,
                     std::max(0.0, day_s - whole) * ticks_per_second, digits);
}

// A take at `rate_hz` that leaves out the frames of `dropped`; frame k has the values k and -k.
std::string take(double rate_hz, double start_s, int frames, const std::vector<int>& dropped = {},
                 double ticks_per_second = 60.0) {
  std::string text = kTwoValues;
  for (int k = 0; k < frames; ++k) {
    if (std::find(dropped.begin(), dropped.end(), k) == dropped.end()) {
      text += fmt::format("{},2,{},{}\n", timecode(start_s + k / rate_hz, ticks_per_second), k, -k);
    }
  }
  return text;
}

MotionClip read(const std::string& text) {
  return parse_live_link_csv(text, "take.csv");
}

void expect_take(const MotionClip& clip, int frames, const std::vector<int>& dropped = {}) {
  ASSERT_EQ(clip.frame_count(), frames);
  for (int k = 0; k < frames; ++k) {
    if (std::find(dropped.begin(), dropped.end(), k) != dropped.end()) {
      EXPECT_TRUE(clip.frames.row(k).array().isNaN().all()) << k;
    } else {
      EXPECT_EQ(clip.frames(k, 0), static_cast<float>(k));
      EXPECT_EQ(clip.frames(k, 1), static_cast<float>(-k));
    }
  }
}

TEST(LiveLink, NominalRatesAt60Ticks) {
  for (const double rate_hz : {60.0, 30.0, 24.0, 60.0 / 1.001, 30.0 / 1.001}) {
    const MotionClip clip = read(take(rate_hz, 3600.0 * 13, 200));
    EXPECT_EQ(clip.rate_hz, rate_hz);
    EXPECT_EQ(clip.start_s, 0.0);
    EXPECT_EQ(clip.channels_per_group, 1);
    EXPECT_EQ(clip.groups, (std::vector<std::string>{"JawOpen", "HeadYaw"}));
    expect_take(clip, 200);
  }
}

TEST(LiveLink, MeasuredRateWhereTheClockIsOff) {
  const MotionClip clip = read(take(59.904, 100.0, 1000));
  EXPECT_NEAR(clip.rate_hz, 59.904, 1e-4);
  expect_take(clip, 1000);
}

TEST(LiveLink, DroppedFramesAreMissing) {
  const std::vector<int> dropped = {3, 70, 71, 72};
  expect_take(read(take(30.0, 5.0, 100, dropped)), 100, dropped);
}

TEST(LiveLink, RowsWithoutATrackedFaceAreMissing) {
  std::string text = kTwoValues;
  text += "01:00:00:00.000,2,0,0\n01:00:00:01.000,0,,\n01:00:00:02.000,2,2,-2\n";
  expect_take(read(text), 3, {1});
}

TEST(LiveLink, RepeatedRowsCountOnce) {
  std::string text = kTwoValues;
  text += "01:00:00:00.000,2,0,0\n01:00:00:01.000,2,1,-1\n01:00:00:01.000,2,1,-1\n"
          "01:00:00:02.000,2,2,-2\n";
  expect_take(read(text), 3);
}

TEST(LiveLink, OverMidnight) {
  const MotionClip clip = read(take(30.0, 86399.0, 90));
  EXPECT_EQ(clip.rate_hz, 30.0);
  expect_take(clip, 90);
}

// Where the ticks wrap at 30 there are 30 of them in a second; a short or a slow take proves
// nothing.
TEST(LiveLink, OtherTicksWhereTheTakeProvesThem) {
  const MotionClip clip = read(take(30.0, 100.0, 150, {}, 30.0));
  EXPECT_EQ(clip.rate_hz, 30.0);
  expect_take(clip, 150);
  EXPECT_EQ(read(take(60.0, 100.0, 20)).rate_hz, 60.0);
}

TEST(LiveLink, NamesInAnyCaseComeOutCanonical) {
  const MotionClip clip = read("timecode,blendshapecount,jawopen,HEADYAW\n"
                               "01:00:00:00,2,0,0\n01:00:00:01,2,1,-1\n");
  EXPECT_EQ(clip.groups, (std::vector<std::string>{"JawOpen", "HeadYaw"}));
  EXPECT_EQ(clip.rate_hz, 60.0);
}

TEST(LiveLink, HostileFiles) {
  const std::string h = kTwoValues;
  const std::vector<Case> cases = {
      {"Timecode,Count,JawOpen\n", "take.csv:1: this is not the header of a Live Link Face table"},
      {"Timecode,BlendShapeCount\n", "this is not the header of a Live Link Face table"},
      {"Timecode,BlendShapeCount,JawOpne\n", "Did you mean \"JawOpen\""},
      {"Timecode,BlendShapeCount,JawOpen,jawopen\n", "column \"JawOpen\" is there twice"},
      {h, "the frame rate cannot be deduced from the timecodes"},
      {h + "01:00:00:00.000,2,0,0\n", "the frame rate cannot be deduced from the timecodes"},
      {h + "01:00:00:00.000,61,0,0\n",
       "take.csv:2: the blendshape count is not that of the header"},
      {h + "01:00:00:00.000,x,0,0\n", "take.csv:2: the blendshape count is not that of the header"},
      {h + "01:00:00:00.000,2,0\n", "take.csv:2: the row has another number of fields"},
      {h + "01:00:00.000,2,0,0\n", "take.csv:2: the timecode cannot be read"},
      {h + "01:60:00:00.000,2,0,0\n", "take.csv:2: the timecode cannot be read"},
      {h + "01:00:00:60.000,2,0,0\n", "take.csv:2: the timecode cannot be read"},
      {h + "01:00:00:-1,2,0,0\n", "take.csv:2: the timecode cannot be read"},
      {h + "01:00:00:00,2,0,0\n01:00:00:00,2,0,0\n", "all rows have the same timecode"},
      {h + "01:00:00:00,2,0,0\n01:00:00:01,2,0,0\n01:00:00:01,2,0,1\n01:00:00:02,2,0,0\n",
       "take.csv:4: the row has the time of the row before it, but other values"},
      {h + "01:00:00:00,2,0,0\n01:00:00:01,2,0,0\n01:00:00:00,2,0,0\n01:00:00:02,2,0,0\n",
       "take.csv:4: the timecodes run backwards"},
      {h + "01:00:00:00,2,0,0\n01:00:00:01,2,0,0\n01:00:00:02,2,0,0\n05:00:00:02,2,0,0\n",
       "take.csv:5: the take has too many dropped frames"},
      {h + "01:00:00:00,2,0,0\n01:00:00:01,2,zero,0\n",
       "column \"JawOpen\" does not hold a number"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.message);
    test::expect_error([&] { read(c.text); }, c.message);
  }
}

void expect_all_values(const MotionClip& clip) {
  ASSERT_EQ(clip.groups.size(), kLiveLinkColumns.size());
  for (std::size_t i = 0; i < kLiveLinkColumns.size(); ++i) {
    EXPECT_EQ(clip.groups[i], kLiveLinkColumns[i]);
  }
}

// take.json says: 27.143264 s from the first frame's timestamp to that of the last but one.
TEST(LiveLink, RealTakeAt60) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const MotionClip clip = read_motion(data / "livelink/sentien/recording.csv");
  expect_all_values(clip);
  ASSERT_EQ(clip.frame_count(), 1628);
  EXPECT_EQ(clip.frames.array().isNaN().count(), 0);
  EXPECT_NEAR(1626.0 / clip.rate_hz, 559547.517280053 - 559520.374015734, 0.001);
  EXPECT_FLOAT_EQ(clip.frames(0, 1), 0.1743034422F);
}

// 4030 rows, three frames dropped in between; 13:13:04:31.652 to 13:15:18:54.561 in 60ths.
TEST(LiveLink, RealTakeAt30) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const MotionClip clip = read_motion(data / "livelink/alexdjulin/alex_rom_3.csv");
  expect_all_values(clip);
  ASSERT_EQ(clip.frame_count(), 4033);
  EXPECT_EQ(clip.frames.array().isNaN().count(), 3 * 61);
  for (const int row : {596, 2126, 3621}) {
    EXPECT_TRUE(std::isnan(clip.frames(row, 0))) << row;
  }
  EXPECT_NEAR(4032.0 / clip.rate_hz, 134.0 + (54.561 - 31.652) / 60.0, 0.001);
}

} // namespace
} // namespace phonomime
