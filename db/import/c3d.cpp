// SPDX-License-Identifier: GPL-3.0-or-later
// The C3D format (c3d.org): a header block, a section of parameters, then frame after frame the
// points (x, y, z and a fourth value with the residual) and the analog samples.
#include "db/import/c3d_bytes.h"
#include "db/import/c3d_parameters.h"
#include "db/import/c3d_shape.h"
#include "db/import/readers.h"
#include "db/types/text.h"

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr unsigned kMagic = 0x50;
constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

std::vector<std::string> read_labels(const C3dParameters& parameters, std::size_t points,
                                     const C3dBytes& bytes) {
  std::vector<std::string> labels = parameters.texts("POINT:LABELS");
  for (int part = 2; labels.size() < points; ++part) {
    const std::vector<std::string> more = parameters.texts(fmt::format("POINT:LABELS{}", part));
    if (more.empty()) {
      break;
    }
    labels.insert(labels.end(), more.begin(), more.end());
  }
  labels.resize(points);
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < points; ++i) {
    if (labels[i].empty()) {
      labels[i] = fmt::format("*{}", i + 1);
    }
    if (!seen.insert(labels[i]).second) {
      bytes.fail(fmt::format("two points are labelled {}", quoted(labels[i])), {}, {},
                 "Rename one of them.");
    }
  }
  return labels;
}

double unit_mm(const C3dParameters& parameters) {
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits = {
      {{"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}}};
  const std::vector<std::string> units = parameters.texts("POINT:UNITS");
  for (const auto& [name, size_mm] : kUnits) {
    if (!units.empty() && to_lower(units.front()) == name) {
      return size_mm;
    }
  }
  return 0.0;
}

// x, y, z and residual of one point into `xyz`.
template <C3dProcessor processor, bool is_float>
void read_point(const unsigned char* bytes, double scale, float* xyz) {
  bool there = true;
  if constexpr (is_float) {
    there = decode_real<processor>(bytes + 12) >= 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
      xyz[axis] = decode_real<processor>(bytes + 4 * axis);
      there = there && std::isfinite(xyz[axis]);
    }
  } else {
    const auto integer = [&](int i) {
      return static_cast<std::int16_t>(decode_word<processor>(bytes + 2 * i));
    };
    there = integer(3) >= 0;
    for (int axis = 0; axis < 3; ++axis) {
      xyz[axis] = static_cast<float>(integer(axis) * scale);
      there = there && std::isfinite(xyz[axis]);
    }
  }
  if (!there) {
    xyz[0] = xyz[1] = xyz[2] = kMissing;
  }
}

template <C3dProcessor processor, bool is_float>
FrameMatrix read_points(std::string_view data, const C3dShape& shape) {
  FrameMatrix frames(static_cast<Eigen::Index>(shape.frames),
                     static_cast<Eigen::Index>(3 * shape.points));
  const auto* frame = reinterpret_cast<const unsigned char*>(data.data());
  const auto scale = static_cast<double>(shape.scale);
  float* xyz = frames.data();
  for (std::size_t k = 0; k < shape.frames; ++k, frame += shape.frame_bytes()) {
    for (std::size_t point = 0; point < shape.points; ++point, xyz += 3) {
      read_point<processor, is_float>(frame + 4 * shape.value_bytes() * point, scale, xyz);
    }
  }
  return frames;
}

template <C3dProcessor processor>
FrameMatrix read_points(std::string_view data, const C3dShape& shape) {
  return shape.is_float() ? read_points<processor, true>(data, shape)
                          : read_points<processor, false>(data, shape);
}

FrameMatrix read_points(C3dProcessor processor, std::string_view data, const C3dShape& shape) {
  switch (processor) {
  case C3dProcessor::dec:
    return read_points<C3dProcessor::dec>(data, shape);
  case C3dProcessor::mips:
    return read_points<C3dProcessor::mips>(data, shape);
  case C3dProcessor::intel:
    break;
  }
  return read_points<C3dProcessor::intel>(data, shape);
}

} // namespace

MotionClip parse_c3d(std::string_view file, std::string_view where) {
  C3dBytes bytes(file, where);
  const std::size_t parameter_block = bytes.byte(0, "the header");
  if (bytes.byte(1, "the header") != kMagic || parameter_block == 0) {
    bytes.fail("is not a C3D file", "a header whose second byte is 0x50",
               fmt::format("0x{:02x}", bytes.byte(1, "the header")));
  }
  bytes.slice(0, C3dBytes::kBlock, "the header");
  const C3dParameters parameters(bytes, (parameter_block - 1) * C3dBytes::kBlock);
  const C3dShape shape = read_c3d_shape(bytes, parameters);

  MotionClip clip;
  clip.rate_hz = shape.rate_hz;
  clip.start_s = (shape.first_frame - 1.0) / shape.rate_hz;
  clip.groups = read_labels(parameters, shape.points, bytes);
  clip.channels_per_group = 3;
  clip.unit_mm = unit_mm(parameters);
  clip.frames = read_points(bytes.processor(), file.substr(shape.data_begin), shape);
  return clip;
}

} // namespace phonomime
