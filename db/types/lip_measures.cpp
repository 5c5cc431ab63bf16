// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/lip_measures.h"

#include "db/types/errors.h"

#include <cmath>
#include <string>

namespace phonomime {

LipMeasures::LipMeasures(const Layout& layout)
    : channel_count_(static_cast<std::size_t>(layout.channel_count())) {
  if (layout.kind != LayoutKind::markers) {
    return;
  }
  upper_ = layout.find_landmark("lip_upper_inner");
  lower_ = layout.find_landmark("lip_lower_inner");
  right_ = layout.find_landmark("mouth_corner_right");
  left_ = layout.find_landmark("mouth_corner_left");
  lips_ = layout.groups_in(Region::lips);
}

std::optional<double> LipMeasures::aperture_mm(std::span<const double> frame) const {
  check(frame);
  const auto upper = marker(frame, upper_);
  const auto lower = marker(frame, lower_);
  if (!upper || !lower) {
    return std::nullopt;
  }
  return (*upper)[1] - (*lower)[1];
}

std::optional<double> LipMeasures::width_mm(std::span<const double> frame) const {
  check(frame);
  const auto right = marker(frame, right_);
  const auto left = marker(frame, left_);
  if (!right || !left) {
    return std::nullopt;
  }
  return std::hypot((*right)[0] - (*left)[0], (*right)[1] - (*left)[1], (*right)[2] - (*left)[2]);
}

std::optional<double> LipMeasures::protrusion_mm(std::span<const double> frame) const {
  check(frame);
  if (lips_.empty()) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (const int group : lips_) {
    sum += (*marker(frame, group))[2];
  }
  return sum / static_cast<double>(lips_.size());
}

std::optional<std::span<const double, 3>> LipMeasures::marker(std::span<const double> frame,
                                                              std::optional<int> group) const {
  if (!group) {
    return std::nullopt;
  }
  return frame.subspan(static_cast<std::size_t>(*group) * 3).first<3>();
}

void LipMeasures::check(std::span<const double> frame) const {
  if (frame.size() != channel_count_) {
    throw InternalError({.what = "a frame does not fit the layout",
                         .expected = std::to_string(channel_count_) + " channels",
                         .got = std::to_string(frame.size())});
  }
}

} // namespace phonomime
