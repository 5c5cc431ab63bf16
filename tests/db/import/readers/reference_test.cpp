// SPDX-License-Identifier: GPL-3.0-or-later
// Real recordings, read by these readers and by reference_reader.py, which shares nothing with
// them.
#include "db/import/readers.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                            const std::string& suffix) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == suffix) {
      files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  return files;
}

// What the script prints for the files; nothing where there is no Python.
std::string reference(const std::string& mode, const std::vector<std::filesystem::path>& files) {
  std::string command = "python3 -B " + std::string(PHONOMIME_SOURCE_DIR) +
                        "/tests/db/import/readers/reference_reader.py " + mode;
  for (const std::filesystem::path& file : files) {
    command += " '" + file.string() + "'";
  }
  FILE* pipe = popen(command.c_str(), "r");
  std::string output;
  char buffer[1 << 16];
  for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) {
    output.append(buffer, count);
  }
  return pclose(pipe) == 0 ? output : std::string();
}

bool has_python() {
  return std::system("python3 -c pass > /dev/null 2>&1") == 0;
}

TEST(Reference, C3dPointsOfRealRecordings) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  if (!has_python()) {
    GTEST_SKIP() << "skipped: needs python3";
  }
  std::vector<std::filesystem::path> files;
  const std::vector<std::filesystem::path> all = files_in(data / "grid_s1/motion", ".c3d");
  for (std::size_t i = 0; i < all.size(); i += 7) {
    files.push_back(all[i]);
  }
  const std::string output = reference("c3d", files);
  std::size_t at = 0;
  long missing = 0;
  int with_floats = 0;
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file);
    const MotionClip clip = read_motion(file);
    std::int32_t size[2] = {};
    double rate_hz = 0.0;
    ASSERT_LE(at + 16, output.size());
    std::memcpy(size, output.data() + at, 8);
    std::memcpy(&rate_hz, output.data() + at + 8, 8);
    at += 16;
    ASSERT_EQ(clip.frame_count(), size[0]);
    ASSERT_EQ(clip.frames.cols(), size[1]);
    EXPECT_EQ(clip.rate_hz, rate_hz);
    FrameMatrix expected(size[0], size[1]);
    const std::size_t bytes = static_cast<std::size_t>(expected.size()) * sizeof(float);
    ASSERT_LE(at + bytes, output.size());
    std::memcpy(expected.data(), output.data() + at, bytes);
    at += bytes;
    for (Eigen::Index i = 0; i < expected.size(); ++i) {
      const float a = clip.frames.data()[i];
      const float b = expected.data()[i];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " and " << b << " at " << i;
    }
    missing += expected.array().isNaN().count();
    with_floats += std::filesystem::file_size(file) > 100000 ? 1 : 0;
  }
  EXPECT_EQ(at, output.size());
  EXPECT_GT(missing, 0);     // the sample has drop-outs,
  EXPECT_GT(with_floats, 5); // files of floats
  EXPECT_GE(files.size(), 100U);
}

TEST(Reference, AlignmentsOfRealRecordings) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  if (!has_python()) {
    GTEST_SKIP() << "skipped: needs python3";
  }
  for (const std::string suffix : {".lab", ".TextGrid"}) {
    const std::vector<std::filesystem::path> files = files_in(data / "grid_s1/alignment", suffix);
    ASSERT_GE(files.size(), 50U);
    std::istringstream output(reference("rows", files));
    for (const std::filesystem::path& file : files) {
      for (const AlignedLabel& row : read_alignment(file).rows) {
        std::string path, start, end, label;
        ASSERT_TRUE(std::getline(output, path, '\t') && std::getline(output, start, '\t') &&
                    std::getline(output, end, '\t') && std::getline(output, label));
        ASSERT_EQ(path, file.string());
        EXPECT_EQ(row.start_s, std::stod(start)) << file;
        EXPECT_EQ(row.end_s, std::stod(end)) << file;
        EXPECT_EQ(row.label, label) << file;
      }
    }
    EXPECT_EQ(output.peek(), std::istringstream::traits_type::eof());
  }
}

// Every file of the corpus can be read, and in little time: well under a second in a release build.
TEST(Reference, AllRecordingsInLittleTime) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  const std::vector<std::filesystem::path> files = files_in(data / "grid_s1/motion", ".c3d");
  const auto begin = std::chrono::steady_clock::now();
  Eigen::Index frames = 0;
  for (const std::filesystem::path& file : files) {
    const MotionClip clip = read_motion(file);
    EXPECT_EQ(clip.groups.size(), 91U);
    frames += clip.frame_count();
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(files.size(), 800U);
  EXPECT_EQ(frames, 60000);
  RecordProperty("seconds", std::to_string(elapsed.count()));
  EXPECT_LT(elapsed.count(), 20.0); // a loaded machine and a sanitizer allowed for
}

} // namespace
} // namespace phonomime
