// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/c3d_writer.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "db/types/errors.h"
#include "tools/demo/marker_layout.h"

namespace phonomime::demo {

namespace {

constexpr std::size_t kBlock = 512;

class Bytes {
public:
  void byte(int value) { text_ += static_cast<char>(value); }
  void word(int value) {
    byte(value & 0xFF);
    byte((value >> 8) & 0xFF);
  }
  void real(float value) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    word(static_cast<int>(bits & 0xFFFF));
    word(static_cast<int>(bits >> 16));
  }
  void chars(std::string_view value) { text_ += value; }
  void fill_block() { text_.resize((text_.size() + kBlock - 1) / kBlock * kBlock, '\0'); }
  void set_byte(std::size_t at, int value) { text_[at] = static_cast<char>(value); }
  std::size_t size() const { return text_.size(); }
  std::string take() { return std::move(text_); }

private:
  std::string text_;
};

// Type codes of C3D parameters.
enum : int { kCharacters = -1, kWords = 2, kReals = 4 };

// A parameter of a group: name, type, dimensions, and the bytes of its value.
void put_parameter(Bytes& out, int group, std::string_view name, int type,
                   std::vector<int> dimensions, const std::string& value) {
  out.byte(static_cast<int>(name.size()));
  out.byte(group);
  out.chars(name);
  // From here to the next item: this word, type, number of dimensions, dimensions, value, and the
  // length of an empty description.
  out.word(static_cast<int>(2 + 1 + 1 + dimensions.size() + value.size() + 1));
  out.byte(type & 0xFF);
  out.byte(static_cast<int>(dimensions.size()));
  for (const int d : dimensions)
    out.byte(d);
  out.chars(value);
  out.byte(0);
}

void put_group(Bytes& out, int group, std::string_view name) {
  out.byte(static_cast<int>(name.size()));
  out.byte(-group & 0xFF);
  out.chars(name);
  out.word(2 + 1);
  out.byte(0);
}

std::string as_word(int value) {
  Bytes b;
  b.word(value);
  return b.take();
}

std::string as_real(float value) {
  Bytes b;
  b.real(value);
  return b.take();
}

std::string parameter_section(int markers, int frames, float rate_hz, float scale, int data_start) {
  constexpr int kPoint = 1;
  constexpr int kAnalog = 2;
  constexpr int kLabelWidth = 8;
  std::string labels;
  for (const int vertex : marker_vertices()) {
    std::string label = marker_name(vertex);
    label.resize(kLabelWidth, ' ');
    labels += label;
  }
  Bytes out;
  out.byte(1);
  out.byte(0x50);
  out.byte(0);  // number of blocks, set below
  out.byte(84); // Intel
  put_group(out, kPoint, "POINT");
  put_parameter(out, kPoint, "USED", kWords, {}, as_word(markers));
  put_parameter(out, kPoint, "SCALE", kReals, {}, as_real(scale));
  put_parameter(out, kPoint, "RATE", kReals, {}, as_real(rate_hz));
  put_parameter(out, kPoint, "DATA_START", kWords, {}, as_word(data_start));
  put_parameter(out, kPoint, "FRAMES", kWords, {}, as_word(frames));
  put_parameter(out, kPoint, "UNITS", kCharacters, {2}, "mm");
  put_parameter(out, kPoint, "LABELS", kCharacters, {kLabelWidth, markers}, labels);
  put_group(out, kAnalog, "ANALOG");
  put_parameter(out, kAnalog, "USED", kWords, {}, as_word(0));
  out.word(0);
  out.fill_block();
  out.set_byte(2, static_cast<int>(out.size() / kBlock));
  return out.take();
}

std::string header(int markers, int frames, float rate_hz, float scale, int data_start) {
  Bytes out;
  out.byte(2); // the parameters are in block 2
  out.byte(0x50);
  out.word(markers);
  out.word(0); // analog measurements per frame
  out.word(1);
  out.word(frames);
  out.word(0); // longest gap that was filled by interpolation
  out.real(scale);
  out.word(data_start);
  out.word(0); // analog samples per frame
  out.real(rate_hz);
  out.fill_block();
  return out.take();
}

void put_point(Bytes& out, const Eigen::RowVector3d& point, C3dNumbers numbers) {
  const bool missing = !point.allFinite();
  for (int axis = 0; axis < 3; ++axis) {
    const double value = missing ? 0.0 : point[axis];
    if (numbers == C3dNumbers::floats) {
      out.real(static_cast<float>(value));
      continue;
    }
    const double steps = std::round(value / kC3dStep_mm);
    if (std::abs(steps) > 32767.0)
      throw InternalError({.what = "a marker is too far out for a C3D of scaled integers",
                           .expected = "within 327 mm",
                           .got = std::to_string(value) + " mm"});
    out.word(static_cast<int>(steps));
  }
  if (numbers == C3dNumbers::floats)
    out.real(missing ? -1.0f : 0.0f);
  else
    out.word(missing ? -1 : 0);
}

} // namespace

std::string format_c3d(std::span<const MarkerPose> frames, double rate_hz, C3dNumbers numbers) {
  if (frames.empty() || frames.size() > 32767)
    throw InternalError({.what = "a C3D cannot hold this many frames",
                         .expected = "1 to 32767",
                         .got = std::to_string(frames.size())});
  const int count = static_cast<int>(frames.size());
  const int markers = static_cast<int>(frames[0].rows());
  const float rate = static_cast<float>(rate_hz);
  // A negative scale says that the points are floats.
  const float scale = numbers == C3dNumbers::floats ? -kC3dStep_mm : kC3dStep_mm;
  const std::size_t parameter_bytes = parameter_section(markers, count, rate, scale, 0).size();
  const int data_start = static_cast<int>(1 + parameter_bytes / kBlock + 1);

  Bytes out;
  out.chars(header(markers, count, rate, scale, data_start));
  out.chars(parameter_section(markers, count, rate, scale, data_start));
  for (const MarkerPose& frame : frames)
    for (Eigen::Index i = 0; i < frame.rows(); ++i)
      put_point(out, frame.row(i), numbers);
  out.fill_block();
  return out.take();
}

} // namespace phonomime::demo
