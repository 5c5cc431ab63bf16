// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/measured_motion.h"

#include "db/types/lip_measures.h"

#include <cmath>
#include <span>

namespace phonomime {

GroupSets::GroupSets(const Layout& layout) : lips(layout.groups_in(Region::lips)) {
  for (int g = 0; g < layout.group_count(); ++g) {
    const ChannelGroup& group = layout.groups[static_cast<std::size_t>(g)];
    all.push_back(g);
    if (group.in(Region::brows) || group.in(Region::eyelids) || group.in(Region::forehead)) {
      upper_face.push_back(g);
    }
  }
}

MeasuredMotion::MeasuredMotion(const Layout& layout, double rate_hz, const FrameMatrix& frames)
    : frames_(frames.cast<double>()), width_(layout.channels_per_group()), rate_hz_(rate_hz) {
  const LipMeasures lips(layout);
  for (Eigen::Index k = 0; k < frames_.rows(); ++k) {
    const std::span<const double> frame(frames_.row(k).data(),
                                        static_cast<std::size_t>(frames_.cols()));
    add(LipCurve::aperture, lips.aperture_mm(frame));
    add(LipCurve::width, lips.width_mm(frame));
    add(LipCurve::protrusion, lips.protrusion_mm(frame));
  }
}

double MeasuredMotion::speed(std::int64_t k, const std::vector<int>& groups) const {
  double sum = 0.0;
  for (const int group : groups) {
    sum += velocity(k, group).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(groups.size()));
}

double MeasuredMotion::jerk(std::int64_t k, const std::vector<int>& groups) const {
  double sum = 0.0;
  for (const int group : groups) {
    sum += (position(k + 2, group) - 3.0 * position(k + 1, group) + 3.0 * position(k, group) -
            position(k - 1, group))
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(groups.size())) * rate_hz_ * rate_hz_ * rate_hz_;
}

void MeasuredMotion::add(LipCurve which, const std::optional<double>& value) {
  if (value) {
    curves_[static_cast<std::size_t>(which)].push_back(*value);
  }
}

double error_sq(const MeasuredMotion& recorded, const MeasuredMotion& synthesised, std::int64_t k,
                int group) {
  return (synthesised.position(k, group) - recorded.position(k, group)).squaredNorm();
}

} // namespace phonomime
