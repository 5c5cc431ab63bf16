// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"

#include <optional>
#include <span>
#include <vector>

namespace phonomime {

// A phoneme is closed when the smallest aperture over its frames is under this (DESIGN section 2).
inline constexpr double kClosedAperture_mm = 1.5;

// Articulatory measures of single frames, from a layout's landmarks (DESIGN section 2). A frame is
// #channels in the layout's order, in mm, head motion off, x to the right of the picture, y up, z
// towards the camera. A measure is nothing where the layout holds weights or lacks the landmarks.
// Every member throws InternalError where a frame has another number of channels than the layout.
class LipMeasures {
public:
  explicit LipMeasures(const Layout& layout);

  // Vertical distance from lip_lower_inner up to lip_upper_inner; negative where tracked lips
  // overlap, which is closed too.
  std::optional<double> aperture_mm(std::span<const double> frame) const;

  // Distance of mouth_corner_right and mouth_corner_left.
  std::optional<double> width_mm(std::span<const double> frame) const;

  // Mean forward position (z) of the groups in the region lips.
  std::optional<double> protrusion_mm(std::span<const double> frame) const;

private:
  std::optional<std::span<const double, 3>> marker(std::span<const double> frame,
                                                   std::optional<int> group) const;
  void check(std::span<const double> frame) const;

  std::size_t channel_count_ = 0;
  std::optional<int> upper_, lower_, right_, left_; // into Layout::groups
  std::vector<int> lips_;                           // into Layout::groups
};

} // namespace phonomime
