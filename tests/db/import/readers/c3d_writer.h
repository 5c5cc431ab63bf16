// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace phonomime::test {

// What a test C3D file holds. Every number of header and parameters can be made to lie.
struct C3dFile {
  int processor = 84;
  bool floats = false;
  double scale = 0.5;
  double rate_hz = 100.0;
  int first_frame = 1;
  int analog_channels = 0;
  int analog_per_frame = 0; // samples of one channel in a frame
  std::string units = "mm";
  std::vector<std::string> labels = {"a", "b"};
  int frames = 3;
  int label_length = 8;

  // Of (frame, point): x, y, z in file units; a residual below 0 is a missing point.
  struct Point {
    double x = 0.0, y = 0.0, z = 0.0, residual = 0.0;
  };
  std::function<Point(int frame, int point)> point = [](int frame, int index) {
    return Point{frame + 1.0, index + 0.5, -2.0 * frame, 0.0};
  };

  // Parameters instead of, or beside, those that the writer makes; "" as value leaves one out.
  struct Value {
    int type = 2; // -1, 1, 2, 4
    std::vector<int> dimensions;
    std::vector<double> numbers;
    std::string text;
    bool omit = false;
  };
  std::map<std::string, Value> parameters; // "POINT:USED"
  std::map<int, int> header_words;         // word number from 1 -> value
  bool end_mark = true;
};

C3dFile::Value c3d_word(int value);
C3dFile::Value c3d_words(std::vector<double> values);
C3dFile::Value c3d_real(double value);
C3dFile::Value c3d_omit();

std::string write_c3d(const C3dFile& file);

} // namespace phonomime::test
