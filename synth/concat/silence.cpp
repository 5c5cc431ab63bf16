// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/silence.h"

#include "db/types/portable_sine.h"

#include <algorithm>

namespace phonomime {
namespace {

constexpr double kVelocityFades_s = 0.2;

// Where a curve from 0 to 1 is at x in [0, 1], apart from what border velocities add.
double progress_at(double x, SilenceFill fill) {
  switch (fill) {
  case SilenceFill::cosine: {
    const double half = sin_pi(0.5 * x);
    return half * half; // (1 - cos(pi x)) / 2
  }
  case SilenceFill::cubic:
    return x * x * (3.0 - 2.0 * x);
  case SilenceFill::linear:
    break;
  }
  return x;
}

// What a border velocity of 1 a frame adds at a distance from the border: the cubic with slope 1 at
// the border that has come to rest at 0 after `reach` frames.
double carried(double distance, double reach) {
  if (distance >= reach) {
    return 0.0;
  }
  const double left = 1.0 - distance / reach;
  return distance * left * left;
}

class SilenceFiller {
public:
  SilenceFiller(FrameMatrixD& frames, const std::vector<std::uint8_t>& shown,
                const Eigen::RowVectorXd& rest, double rate_hz, const SilenceOptions& options)
      : frames_(frames), shown_(shown), rest_(rest), rate_hz_(rate_hz), options_(options) {}

  // Fills frames [first, end), none of them shown, with shown frames or the motion's ends around.
  void fill(Eigen::Index first, Eigen::Index end) {
    const bool has_left = first > 0;
    const bool has_right = end < frames_.rows();
    if (has_left && has_right) {
      bridge(first - 1, end);
    } else if (has_left) {
      leave(first - 1, +1, end - first);
    } else if (has_right) {
      leave(end, -1, end - first);
    } else {
      frames_.rowwise() = rest_;
    }
  }

private:
  // Change a frame in direction `step` away from a border, as it runs into the silence.
  Eigen::RowVectorXd velocity(Eigen::Index border, Eigen::Index step) const {
    const Eigen::Index inner = border - step;
    if (options_.fill != SilenceFill::cubic || inner < 0 || inner >= frames_.rows() ||
        shown_[static_cast<std::size_t>(inner)] == 0) {
      return Eigen::RowVectorXd::Zero(frames_.cols());
    }
    return frames_.row(border) - frames_.row(inner);
  }

  void bridge(Eigen::Index left, Eigen::Index right) {
    const Eigen::RowVectorXd out_of_left = velocity(left, +1);
    const Eigen::RowVectorXd out_of_right = velocity(right, -1);
    const Eigen::RowVectorXd way = frames_.row(right) - frames_.row(left);
    const double length = static_cast<double>(right - left);
    const double reach = std::min(length, kVelocityFades_s * rate_hz_);
    for (Eigen::Index k = left + 1; k < right; ++k) {
      const double from_left = static_cast<double>(k - left);
      const double from_right = static_cast<double>(right - k);
      frames_.row(k) = frames_.row(left) + progress_at(from_left / length, options_.fill) * way +
                       carried(from_left, reach) * out_of_left +
                       carried(from_right, reach) * out_of_right;
    }
  }

  // Fills `count` frames from a border outwards to an end of the motion.
  void leave(Eigen::Index border, Eigen::Index step, Eigen::Index count) {
    const Eigen::RowVectorXd out_of_border = velocity(border, step);
    const Eigen::RowVectorXd way = rest_ - frames_.row(border);
    const double within = options_.rest_within_s * rate_hz_;
    const double length = std::clamp(static_cast<double>(count), 0.5 * within, within);
    const double reach = std::min(length, kVelocityFades_s * rate_hz_);
    for (Eigen::Index i = 1; i <= count; ++i) {
      const Eigen::Index k = border + i * step;
      const double distance = static_cast<double>(i);
      if (!options_.rest_at_ends) {
        frames_.row(k) = frames_.row(border);
      } else if (distance >= length) {
        frames_.row(k) = rest_;
      } else {
        frames_.row(k) = frames_.row(border) + progress_at(distance / length, options_.fill) * way +
                         carried(distance, reach) * out_of_border;
      }
    }
  }

  FrameMatrixD& frames_;
  const std::vector<std::uint8_t>& shown_;
  const Eigen::RowVectorXd& rest_;
  double rate_hz_;
  const SilenceOptions& options_;
};

} // namespace

void fill_silence(FrameMatrixD& frames, const std::vector<std::uint8_t>& shown,
                  const Eigen::RowVectorXd& rest, double rate_hz, const SilenceOptions& options) {
  SilenceFiller filler(frames, shown, rest, rate_hz, options);
  Eigen::Index first = 0;
  while (first < frames.rows()) {
    Eigen::Index end = first;
    while (end < frames.rows() && shown[static_cast<std::size_t>(end)] == 0) {
      ++end;
    }
    if (end > first) {
      filler.fill(first, end);
    }
    first = end + 1;
  }
}

} // namespace phonomime
