// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/c3d_bytes.h"
#include "db/import/readers.h"
#include "tests/db/import/readers/c3d_writer.h"
#include "tests/support/expect_error.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::C3dFile;
using test::write_c3d;

MotionClip read(const C3dFile& file) {
  return parse_c3d(write_c3d(file), "test.c3d");
}

void expect_points(const MotionClip& clip, const C3dFile& file) {
  ASSERT_EQ(clip.frame_count(), file.frames);
  ASSERT_EQ(clip.groups, file.labels);
  ASSERT_EQ(clip.frames.cols(), static_cast<Eigen::Index>(3 * file.labels.size()));
  for (int k = 0; k < file.frames; ++k) {
    for (int i = 0; i < static_cast<int>(file.labels.size()); ++i) {
      const C3dFile::Point p = file.point(k, i);
      EXPECT_EQ(clip.frames(k, 3 * i), static_cast<float>(p.x)) << k << " " << i;
      EXPECT_EQ(clip.frames(k, 3 * i + 1), static_cast<float>(p.y));
      EXPECT_EQ(clip.frames(k, 3 * i + 2), static_cast<float>(p.z));
    }
  }
}

// All three processors, integers and floats, with and without analog samples between the points:
// the same points come out.
class EveryKindOfC3d : public ::testing::TestWithParam<std::tuple<int, bool, int>> {};

TEST_P(EveryKindOfC3d, GivesThePointsThatWereWritten) {
  C3dFile file;
  std::tie(file.processor, file.floats, file.analog_per_frame) = GetParam();
  file.analog_channels = file.analog_per_frame > 0 ? 3 : 0;
  file.frames = 40;
  const MotionClip clip = read(file);
  expect_points(clip, file);
  EXPECT_EQ(clip.rate_hz, 100.0);
  EXPECT_EQ(clip.start_s, 0.0);
  EXPECT_EQ(clip.unit_mm, 1.0);
  EXPECT_EQ(clip.channels_per_group, 3);
}

INSTANTIATE_TEST_SUITE_P(C3d, EveryKindOfC3d,
                         ::testing::Combine(::testing::Values(84, 85, 86), ::testing::Bool(),
                                            ::testing::Values(0, 5)));

// Known numbers of VAX F_floating (VAX Architecture Reference Manual): 1 is 0x4080, -7.5 is 0xC1F0.
TEST(DecFloat, DecodesKnownNumbers) {
  const auto decode = [](int b0, int b1, int b2, int b3) {
    const unsigned char bytes[] = {static_cast<unsigned char>(b0), static_cast<unsigned char>(b1),
                                   static_cast<unsigned char>(b2), static_cast<unsigned char>(b3)};
    return decode_dec_float(bytes);
  };
  EXPECT_EQ(decode(0x80, 0x40, 0, 0), 1.0F);
  EXPECT_EQ(decode(0xF0, 0xC1, 0, 0), -7.5F);
  EXPECT_EQ(decode(0x49, 0x41, 0xD0, 0x0F), 3.14159012F);
  EXPECT_EQ(decode(0x00, 0x00, 0x12, 0x34), 0.0F);
  EXPECT_TRUE(std::isnan(decode(0x00, 0x80, 0, 0)));
}

TEST(C3d, MissingPointsAreNaN) {
  for (const bool floats : {false, true}) {
    C3dFile file;
    file.floats = floats;
    file.point = [](int frame, int point) {
      return C3dFile::Point{1.0, 2.0, 3.0, frame == 1 && point == 0 ? -1.0 : 0.0};
    };
    const MotionClip clip = read(file);
    EXPECT_TRUE(clip.frames.row(1).head(3).array().isNaN().all());
    EXPECT_EQ(clip.frames(1, 3), 1.0F);
    EXPECT_EQ(clip.frames.array().isNaN().count(), 3);
  }
}

TEST(C3d, CoordinatesThatAreNotFiniteAreMissing) {
  C3dFile file;
  file.floats = true;
  file.point = [](int frame, int point) {
    const double y = frame == 0   ? std::numeric_limits<double>::infinity()
                     : frame == 1 ? std::numeric_limits<double>::quiet_NaN()
                                  : 2.0;
    return C3dFile::Point{1.0, point == 1 ? y : 2.0, 3.0, 0.0};
  };
  const MotionClip clip = read(file);
  EXPECT_EQ(clip.frames.array().isNaN().count(), 6);
  EXPECT_TRUE(clip.frames.block(0, 3, 2, 3).array().isNaN().all());
}

TEST(C3d, FirstFrameGivesTheStart) {
  C3dFile file;
  file.first_frame = 51;
  EXPECT_EQ(read(file).start_s, 0.5);
  file.first_frame = 0; // some programs count from 0
  file.header_words[5] = 2;
  EXPECT_EQ(read(file).start_s, 0.0);
  file.parameters["TRIAL:ACTUAL_START_FIELD"] = test::c3d_words({101, 0});
  file.parameters["TRIAL:ACTUAL_END_FIELD"] = test::c3d_words({103, 0});
  EXPECT_EQ(read(file).start_s, 1.0);
}

TEST(C3d, MoreThan255Labels) {
  C3dFile file;
  file.labels.clear();
  for (int i = 0; i < 600; ++i) {
    file.labels.push_back(fmt::format("m{}", i));
  }
  expect_points(read(file), file);
}

TEST(C3d, PointsWithoutLabelsAreNumbered) {
  C3dFile file;
  file.labels = {"a", "", "c", ""};
  EXPECT_EQ(read(file).groups, (std::vector<std::string>{"a", "*2", "c", "*4"}));
  file.parameters["POINT:LABELS"] = test::c3d_omit();
  EXPECT_EQ(read(file).groups, (std::vector<std::string>{"*1", "*2", "*3", "*4"}));
}

TEST(C3d, MoreLabelsThanPoints) {
  C3dFile file;
  file.labels = {"a", "b", "c", "d"};
  const std::string label_text = "a       b       c       d       ghost   ";
  file.parameters["POINT:LABELS"] = {
      .type = -1, .dimensions = {8, 5}, .numbers = {}, .text = label_text};
  EXPECT_EQ(read(file).groups, file.labels);
}

TEST(C3d, ParametersCountWhereTheHeaderDiffers) {
  C3dFile file;
  file.header_words[2] = 77; // points
  file.header_words[5] = 1;  // last frame
  expect_points(read(file), file);
}

TEST(C3d, FramesAsFloat) {
  C3dFile file;
  file.parameters["POINT:FRAMES"] = test::c3d_real(3.0);
  file.header_words[5] = 65535;
  expect_points(read(file), file);
}

// The three ways of more than 65535 frames.
TEST(C3d, LongTakes) {
  C3dFile file;
  file.labels = {"a"};
  file.frames = 70000;
  file.point = [](int frame, int) { return C3dFile::Point{(frame % 1000) * 1.0, 2.0, 3.0, 0.0}; };
  C3dFile by_float = file;
  by_float.parameters["POINT:FRAMES"] = test::c3d_real(70000.0);
  C3dFile by_long = file;
  by_long.parameters["POINT:LONG_FRAMES"] = test::c3d_real(70000.0);
  C3dFile by_trial = file;
  by_trial.parameters["TRIAL:ACTUAL_START_FIELD"] = test::c3d_words({1, 0});
  by_trial.parameters["TRIAL:ACTUAL_END_FIELD"] = test::c3d_words({70000 - 65536, 1});
  C3dFile wrapped = by_trial;
  wrapped.parameters["POINT:FRAMES"] = test::c3d_word(70000 - 65536);
  for (const C3dFile& variant : {by_float, by_long, by_trial, wrapped}) {
    const MotionClip clip = read(variant);
    ASSERT_EQ(clip.frame_count(), 70000);
    EXPECT_EQ(clip.frames(69999, 0), 999.0F);
  }
}

TEST(C3d, Units) {
  const auto unit = [](const std::string& name) {
    C3dFile file;
    file.units = name;
    return read(file).unit_mm;
  };
  EXPECT_EQ(unit("mm"), 1.0);
  EXPECT_EQ(unit("CM  "), 10.0);
  EXPECT_EQ(unit("m"), 1000.0);
  EXPECT_EQ(unit("furlong"), 0.0);
  EXPECT_EQ(unit(""), 0.0);
}

TEST(C3d, DataStartOfTheHeaderCountsAndItsCopyServes) {
  C3dFile file;
  file.parameters["POINT:DATA_START"] = test::c3d_word(99);
  expect_points(read(file), file);
  C3dFile by_parameter;
  by_parameter.header_words[9] = 0;
  expect_points(read(by_parameter), by_parameter);
}

TEST(C3d, AnalogSamplesAreWhatFillsTheFile) {
  C3dFile file;
  file.frames = 100;
  file.analog_channels = 4;
  file.analog_per_frame = 10;
  C3dFile header_lies = file;
  header_lies.header_words[3] = 0;
  expect_points(read(header_lies), file);
  C3dFile parameters_lie = file;
  parameters_lie.parameters["ANALOG:USED"] = test::c3d_word(1);
  expect_points(read(parameters_lie), file);
}

// Where the last record ends exactly with its block there is no room for an end mark.
TEST(C3d, SectionWithoutEndMark) {
  int filled_blocks = 0;
  for (int padding = 0; padding < 512; ++padding) { // every length of the section, modulo a block
    C3dFile file;
    file.label_length = padding < 256 ? 8 : 8 + 128;
    file.parameters["TRIAL:PADDING"] = {.type = 1,
                                        .dimensions = {padding % 256},
                                        .numbers = std::vector<double>(padding % 256, 7.0),
                                        .text = {}};
    const std::size_t with_mark = write_c3d(file).size();
    file.end_mark = false;
    filled_blocks += write_c3d(file).size() < with_mark ? 1 : 0;
    expect_points(read(file), file);
  }
  EXPECT_EQ(filled_blocks, 2); // filled, or but for the one byte that marks the end
}

TEST(C3d, HostileFiles) {
  struct Case {
    const char* name;
    std::function<void(C3dFile&)> damage;
    const char* message;
  };
  const std::vector<Case> cases = {
      {"duplicate label",
       [](C3dFile& f) {
         f.labels = {"a", "a"};
       },
       "two points are labelled \"a\""},
      {"huge points", [](C3dFile& f) { f.parameters["POINT:USED"] = test::c3d_word(65535); },
       "the data section is cut off"},
      {"huge float points", [](C3dFile& f) { f.parameters["POINT:USED"] = test::c3d_real(4e9); },
       "the data section is cut off"},
      {"points beyond", [](C3dFile& f) { f.parameters["POINT:USED"] = test::c3d_real(1e30); },
       "the number of points is not usable"},
      {"points NaN", [](C3dFile& f) { f.parameters["POINT:USED"] = test::c3d_real(NAN); },
       "the number of points is not usable"},
      {"no points", [](C3dFile& f) { f.parameters["POINT:USED"] = test::c3d_word(0); },
       "the number of points is not usable"},
      {"negative frames", [](C3dFile& f) { f.parameters["POINT:FRAMES"] = test::c3d_real(-3.0); },
       "the number of frames is not usable"},
      {"half frames", [](C3dFile& f) { f.parameters["POINT:FRAMES"] = test::c3d_real(1.5); },
       "the number of frames is not usable"},
      {"huge frames", [](C3dFile& f) { f.parameters["POINT:FRAMES"] = test::c3d_word(60000); },
       "the data section is cut off"},
      {"huge long frames",
       [](C3dFile& f) { f.parameters["POINT:LONG_FRAMES"] = test::c3d_real(4294967040.0); },
       "the data section is cut off"},
      {"reversed header",
       [](C3dFile& f) {
         f.parameters["POINT:FRAMES"] = test::c3d_omit();
         f.header_words[4] = 9;
         f.header_words[5] = 3;
       },
       "the number of frames is not usable"},
      {"rate 0",
       [](C3dFile& f) {
         f.parameters["POINT:RATE"] = test::c3d_real(-1.0);
         f.rate_hz = 0.0;
       },
       "the frame rate is not usable"},
      {"scale 0", [](C3dFile& f) { f.parameters["POINT:SCALE"] = test::c3d_real(0.0); },
       "POINT:SCALE is not usable"},
      {"scale infinite", [](C3dFile& f) { f.parameters["POINT:SCALE"] = test::c3d_real(INFINITY); },
       "POINT:SCALE is not usable"},
      {"scale of two minds", [](C3dFile& f) { f.parameters["POINT:SCALE"] = test::c3d_real(-0.5); },
       "do not agree whether the points are integers or floats"},
      {"data outside",
       [](C3dFile& f) {
         f.header_words[9] = 65000;
         f.parameters["POINT:DATA_START"] = test::c3d_word(65000);
       },
       "the data section does not begin inside the file"},
      {"data in the parameters",
       [](C3dFile& f) {
         f.header_words[9] = 2;
         f.parameters["POINT:DATA_START"] = test::c3d_word(2);
       },
       "the data section does not begin inside the file"},
      {"processor", [](C3dFile& f) { f.processor = 83; }, "unknown processor type"},
      {"parameters outside", [](C3dFile& f) { f.header_words[1] = 200 | 0x50 << 8; },
       "the parameter section lies outside the file"},
      {"no parameter block", [](C3dFile& f) { f.header_words[1] = 0 | 0x50 << 8; },
       "is not a C3D file"},
      {"magic", [](C3dFile& f) { f.header_words[1] = 2 | 0x51 << 8; }, "is not a C3D file"},
      {"type",
       [](C3dFile& f) {
         f.parameters["POINT:X"] = {.type = 3, .dimensions = {}, .numbers = {1}, .text = {}};
       },
       "is of an unknown type"},
      {"many dimensions",
       [](C3dFile& f) {
         f.parameters["POINT:X"] = {
             .type = 1, .dimensions = std::vector<int>(8, 1), .numbers = {1}, .text = {}};
       },
       "has too many dimensions"},
      {"huge dimensions",
       [](C3dFile& f) {
         f.parameters["POINT:X"] = {
             .type = 4, .dimensions = std::vector<int>(7, 255), .numbers = {1}, .text = {}};
       },
       "do not fit into its record"},
      {"analog",
       [](C3dFile& f) {
         f.frames = 200;
         f.header_words[3] = 500;
         f.parameters["ANALOG:USED"] = test::c3d_word(30);
         f.parameters["ANALOG:RATE"] = test::c3d_real(100.0);
       },
       "do not agree on the analog samples"},
      {"first frame",
       [](C3dFile& f) { f.parameters["TRIAL:ACTUAL_START_FIELD"] = test::c3d_real(-5.0); },
       "the number of the first frame is not usable"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    C3dFile file;
    c.damage(file);
    test::expect_error([&] { read(file); }, c.message);
    test::expect_error([&] { read(file); }, "test.c3d: ");
  }
}

// A record whose link leads back to itself, and one that leads outside.
TEST(C3d, LyingLinks) {
  const std::string bytes = write_c3d({});
  const std::size_t link = 512 + 4 + 2 + 6; // of the first group, ANALOG
  for (const auto& [low, high, message] : {std::tuple{1, 0, "leads back to itself"},
                                           std::tuple{0xFF, 0xFF, "leads outside the file"}}) {
    std::string damaged = bytes;
    damaged[link] = static_cast<char>(low);
    damaged[link + 1] = static_cast<char>(high);
    test::expect_error([&] { parse_c3d(damaged, "test.c3d"); }, message);
  }
}

} // namespace
} // namespace phonomime
