// SPDX-License-Identifier: GPL-3.0-or-later
// Every truncation of a valid file of each format, and thousands of random mutations: a reader
// gives a sound result or throws InputError, and nothing else.
#include "db/import/readers.h"
#include "tests/db/import/readers/c3d_writer.h"
#include "tests/db/import/readers/textgrid_samples.h"

#include "db/types/errors.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

void check(const Alignment& alignment, std::size_t) {
  double end_s = 0.0;
  ASSERT_FALSE(alignment.rows.empty());
  for (const AlignedLabel& row : alignment.rows) {
    ASSERT_GE(row.start_s, end_s);
    ASSERT_GE(row.end_s, row.start_s);
    ASSERT_TRUE(std::isfinite(row.end_s));
    end_s = row.end_s;
  }
}

void check(const MotionClip& clip, std::size_t file_bytes) {
  ASSERT_TRUE(std::isfinite(clip.rate_hz) && clip.rate_hz > 0.0);
  ASSERT_TRUE(std::isfinite(clip.start_s));
  ASSERT_GT(clip.frame_count(), 0);
  ASSERT_EQ(clip.frames.cols(),
            static_cast<Eigen::Index>(clip.groups.size()) * clip.channels_per_group);
  ASSERT_FALSE(clip.frames.array().isInf().any());
  ASSERT_LE(static_cast<std::size_t>(clip.frames.size()) * sizeof(float), 16 * file_bytes);
}

struct Format {
  const char* name;
  std::string bytes;
  std::function<void(const std::string&)> read_and_check;
};

template <typename Read>
std::function<void(const std::string&)> checked(Read read) {
  return [read](const std::string& bytes) { check(read(bytes), bytes.size()); };
}

std::string small_c3d(bool floats, int processor) {
  test::C3dFile file;
  file.floats = floats;
  file.processor = processor;
  file.analog_channels = 2;
  file.analog_per_frame = 2;
  return test::write_c3d(file);
}

std::vector<Format> formats() {
  const auto c3d = checked([](const std::string& b) { return parse_c3d(b, "f"); });
  const auto textgrid = checked([](const std::string& b) { return parse_textgrid(b, "f"); });
  const auto xlabel = checked([](const std::string& b) { return parse_xlabel(b, "f"); });
  const auto htk = checked([](const std::string& b) { return parse_htk_label(b, "f"); });
  const auto markers = checked([](const std::string& b) { return parse_marker_csv(b, "f"); });
  const auto live_link = checked([](const std::string& b) { return parse_live_link_csv(b, "f"); });
  return {
      {"C3D of integers", small_c3d(false, 84), c3d},
      {"C3D of floats", small_c3d(true, 84), c3d},
      {"C3D of DEC floats", small_c3d(true, 85), c3d},
      {"C3D of MIPS integers", small_c3d(false, 86), c3d},
      {"long TextGrid", test::kLongTextGrid, textgrid},
      {"short TextGrid", test::kShortTextGrid, textgrid},
      {"UTF-16 TextGrid", test::to_utf16(test::kShortTextGrid, false), textgrid},
      {"xlabel", "nfields 1\n#\n0.25 100 pau\n0.5 100 b ; x\n1.5 100 ih\n", xlabel},
      {"HTK", "0 2500000 pau\n2500000 5000000 b -1.5\n5000000 9000000 \"ih\"\n", htk},
      {"marker CSV", "time,\"a_x\",a_y,a_z\n0,1,2,3\n0.04,1e1,,3\n0.08,-1,nan,3\n0.12,1,2,3\n",
       markers},
      {"weight CSV", "time,JawOpen,b\n0,0.5,1\n0.04,,0.25\n0.08,1,1\n", markers},
      {"Live Link CSV",
       "Timecode,BlendShapeCount,JawOpen,HeadYaw\n13:13:04:58.652,2,0.5,-0.1\n"
       "13:13:05:00.652,2,0.25,0\n13:13:05:02.651,0,,\n13:13:05:06.651,2,1,1e-3\n",
       live_link},
  };
}

// Gives whether the file was taken.
bool try_to_read(const Format& format, const std::string& bytes) {
  try {
    format.read_and_check(bytes);
    return true;
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("f:")) << error.what();
    return false;
  }
}

TEST(Mutations, EveryTruncation) {
  for (const Format& format : formats()) {
    SCOPED_TRACE(format.name);
    ASSERT_TRUE(try_to_read(format, format.bytes));
    for (std::size_t length = 0; length < format.bytes.size(); ++length) {
      ASSERT_NO_THROW(try_to_read(format, format.bytes.substr(0, length))) << length;
    }
  }
}

std::string mutate(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return random() % n; };
  static const std::vector<std::string> kPieces = {"\"",
                                                   "\n",
                                                   ",",
                                                   ";",
                                                   "#",
                                                   "-",
                                                   "1e308",
                                                   "99999999999",
                                                   "nan",
                                                   "0",
                                                   std::string(1, '\0'),
                                                   "\xFF",
                                                   "\xFF\xFF\xFF\x7F",
                                                   "!",
                                                   "<exists>",
                                                   ":"};
  for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = std::min(1 + below(16), bytes.size() - at);
    switch (below(6)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
      break;
    case 1:
      bytes[at] = static_cast<char>(below(256));
      break;
    case 2:
      bytes.erase(at, length);
      break;
    case 3:
      bytes.insert(at, bytes.substr(below(bytes.size()), length));
      break;
    case 4:
      bytes.replace(at, length, kPieces[below(kPieces.size())]);
      break;
    default:
      std::swap(bytes[at], bytes[below(bytes.size())]);
    }
  }
  return bytes;
}

TEST(Mutations, RandomOnes) {
  constexpr int kTries = 3000;
  for (const Format& format : formats()) {
    SCOPED_TRACE(format.name);
    std::mt19937 random(17);
    int taken = 0;
    for (int i = 0; i < kTries; ++i) {
      const std::string bytes = mutate(format.bytes, random);
      ASSERT_NO_THROW(taken += try_to_read(format, bytes) ? 1 : 0) << i;
      if (::testing::Test::HasFatalFailure()) {
        FAIL() << "mutation " << i;
      }
    }
    // Both outcomes are seen: the mutations neither miss the file nor wreck it.
    EXPECT_GT(taken, kTries / 100);
    EXPECT_LT(taken, kTries * 99 / 100);
  }
}

} // namespace
} // namespace phonomime
