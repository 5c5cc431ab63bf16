// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "tests/db/import/readers/textgrid_samples.h"
#include "tests/support/expect_error.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

struct Case {
  std::string text;
  const char* message;
};

MotionClip read(const std::string& text) {
  return parse_marker_csv(text, "m.csv");
}

TEST(MarkerCsv, MarkersInMillimetres) {
  const std::string text = "time,a_x,a_y,a_z,b_x,b_y,b_z\n"
                           "0.5,1,2,3,4,5,6\n"
                           "0.75,-1,2.5,3e1,4,,6\n"
                           "1,1,2,3,NaN,5,6\n";
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : text) {
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  }
  const std::string quotes = test::replaced(text, "time,a_x,a_y", "\"time\", \"a_x\" ,\"a_y\"");
  for (const std::string& variant : {text, windows, quotes, test::to_utf16(text, false)}) {
    const MotionClip clip = read(variant);
    EXPECT_EQ(clip.groups, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(clip.channels_per_group, 3);
    EXPECT_EQ(clip.unit_mm, 1.0);
    EXPECT_EQ(clip.rate_hz, 4.0);
    EXPECT_EQ(clip.start_s, 0.5);
    ASSERT_EQ(clip.frame_count(), 3);
    EXPECT_EQ(clip.frames(1, 2), 30.0F);
    EXPECT_EQ(clip.frames(0, 5), 6.0F);
    // A marker of which one coordinate is missing is missing.
    EXPECT_TRUE(clip.frames.block(1, 3, 2, 3).array().isNaN().all());
    EXPECT_EQ(clip.frames.array().isNaN().count(), 6);
  }
}

TEST(MarkerCsv, Weights) {
  const MotionClip clip = read("Time,JawOpen,max_x\n0,0.5,1\n0.04,,0.25\n");
  EXPECT_EQ(clip.groups, (std::vector<std::string>{"JawOpen", "max_x"}));
  EXPECT_EQ(clip.channels_per_group, 1);
  EXPECT_EQ(clip.unit_mm, 0.0);
  EXPECT_EQ(clip.rate_hz, 25.0);
  EXPECT_TRUE(std::isnan(clip.frames(1, 0)));
  EXPECT_EQ(clip.frames(1, 1), 0.25F);
}

// Times that were rounded when they were written still give the nominal rate; others the fitted
// one.
TEST(MarkerCsv, RateFromRoundedTimes) {
  const auto rate = [](double rate_hz, int digits, int frames) {
    std::string text = "time,a\n";
    for (int k = 0; k < frames; ++k) {
      text += fmt::format("{:.{}f},0\n", k / rate_hz, digits);
    }
    return read(text).rate_hz;
  };
  EXPECT_EQ(rate(30.0, 3, 300), 30.0);
  EXPECT_EQ(rate(120.0, 4, 1000), 120.0);
  EXPECT_EQ(rate(30000.0 / 1001.0, 6, 2000), 30.0 / 1.001);
  EXPECT_EQ(rate(1000.0, 3, 50), 1000.0);
  EXPECT_NEAR(rate(333.3, 9, 500), 333.3, 1e-4);
}

TEST(MarkerCsv, HostileFiles) {
  const std::string header = "time,a_x,a_y,a_z\n";
  const std::vector<Case> cases = {
      {"", "the table is empty"},
      {"\n\n", "the table is empty"},
      {"frame,a\n0,1\n1,1\n", "m.csv:1: the first column is not the time"},
      {"time\n0\n1\n", "m.csv:1: the table has no column beside the time"},
      {"time;a_x;a_y;a_z\n", "m.csv:1: the fields are not separated by commas"},
      {header, "the frame rate cannot be deduced from the times"},
      {header + "0,1,2,3\n", "the frame rate cannot be deduced from the times"},
      {header + "0,1,2,3\n0.04,1,2\n0.08,1,2,3\n",
       "m.csv:3: the row has another number of fields than the header (expected 4 fields, got 3)"},
      {header + "0,1,2,3\n0.04,1,2,3,4\n", "m.csv:3: the row has another number of fields"},
      {header + "0,1,2,3\n0.04,1,x,3\n", "m.csv:3: column \"a_y\" does not hold a number"},
      {header + "0,1,2,3\n0.04,1,inf,3\n", "m.csv:3: column \"a_y\" does not hold a number"},
      {header + "0,1,2,3\n0.04,1,1e300,3\n", "m.csv:3: column \"a_y\" does not hold a number"},
      {header + "0,1,2,3\n,1,2,3\n", "m.csv:3: the time is not a number"},
      {header + "0,1,2,3\n0.04,1,2,3\n0.04,1,2,3\n",
       "m.csv:4: the times run backwards or stand still"},
      {header + "0,1,2,3\n0.04,1,2,3\n0.03,1,2,3\n",
       "m.csv:4: the times run backwards or stand still"},
      {header + "0,1,2,3\n0.04,1,2,3\n0.08,1,2,3\n0.16,1,2,3\n0.20,1,2,3\n",
       "m.csv:5: the times are not uniform (expected a row every 0.04 s, so 0.12 s here, got 0.16 "
       "s)"},
      {"time,a_x,a_y\n0,1,2\n1,1,2\n", "the columns of a marker are not together"},
      {"time,a_x,a_y,a_z,b_x,c_y,b_z\n0,1,2,3,4,5,6\n", "the columns of a marker are not together"},
      {"time,a_x,a_y,a_z,w\n0,1,2,3,4\n", "the columns of a marker are not together"},
      {"time,a_x,a_y,a_z,a_x,a_y,a_z\n0,1,2,3,4,5,6\n", "\"a\" is there twice"},
      {"time,w,w\n0,1,2\n", "\"w\" is there twice"},
      {"time,w,\n0,1,2\n", "column 3 has no name"},
      {"time,\"w\n0,1\n", "m.csv:1: a quote has no end on its line"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.message);
    test::expect_error([&] { read(c.text); }, c.message);
  }
}

// Each step is nearly right, but together they drift: the second half runs at another rate.
TEST(MarkerCsv, DriftIsNotUniform) {
  std::string text = "time,a\n";
  double time_s = 0.0;
  for (int k = 0; k < 400; ++k) {
    text += fmt::format("{:.6f},0\n", time_s);
    time_s += k < 200 ? 0.0100 : 0.0104;
  }
  test::expect_error([&] { read(text); }, "the times are not uniform");
}

} // namespace
} // namespace phonomime
