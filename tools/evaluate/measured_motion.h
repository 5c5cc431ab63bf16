// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"
#include "tools/evaluate/measure_sums.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace phonomime {

// A layout's groups that measures speak of, into Layout::groups.
struct GroupSets {
  explicit GroupSets(const Layout& layout);
  std::vector<int> all;
  std::vector<int> lips;
  std::vector<int> upper_face; // brows, eyelids and forehead
};

// A recording or a synthesis as measures see it: positions of groups (#channels per group, mm or
// weights) at frames, their derivatives by differences of frames, and the curves of the lips.
class MeasuredMotion {
public:
  // `frames`: #frames by #channels of the layout.
  MeasuredMotion(const Layout& layout, double rate_hz, const FrameMatrix& frames);

  // #frames, or empty where the layout has no such curve.
  const std::vector<double>& curve(LipCurve which) const {
    return curves_[static_cast<std::size_t>(which)];
  }

  auto position(std::int64_t k, int group) const {
    return frames_.row(k).segment(static_cast<Eigen::Index>(group) * width_, width_);
  }

  // One-sided: x[k] - x[k-1], times the rate.
  auto velocity(std::int64_t k, int group) const {
    return (position(k, group) - position(k - 1, group)) * rate_hz_;
  }

  // Root mean square over groups of the norm of the velocity at k.
  double speed(std::int64_t k, const std::vector<int>& groups) const;

  // Root mean square over groups of the norm of x[k+2] - 3 x[k+1] + 3 x[k] - x[k-1], times rate^3.
  double jerk(std::int64_t k, const std::vector<int>& groups) const;

private:
  void add(LipCurve which, const std::optional<double>& value);

  FrameMatrixD frames_;
  Eigen::Index width_;
  double rate_hz_;
  std::array<std::vector<double>, kLipCurves> curves_;
};

// Squared norm of the difference of a group's positions in frame k.
double error_sq(const MeasuredMotion& recorded, const MeasuredMotion& synthesised, std::int64_t k,
                int group);

} // namespace phonomime
