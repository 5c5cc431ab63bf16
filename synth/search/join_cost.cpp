// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_cost.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace phonomime {

namespace {

PHONOMIME_DISPATCHED
double summed_group_norms(const float* a, const float* b, std::size_t stride, int axes) {
  return axes == 3 ? summed_norms<DoubleLanes, kDoubleLanes, 3>(a, b, stride)
                   : summed_norms<DoubleLanes, kDoubleLanes, 1>(a, b, stride);
}

// The same in single precision.
PHONOMIME_DISPATCHED
float rough_group_norms(const float* a, const float* b, std::size_t stride, int axes) {
  return axes == 3 ? summed_norms<FloatLanes, kFloatLanes, 3>(a, b, stride)
                   : summed_norms<FloatLanes, kFloatLanes, 1>(a, b, stride);
}

// Covers the rounding of sums of positive numbers in single precision.
constexpr double kRelativeMargin = 1e-5;

// At least this many dimensions of a blended frame are kept without allocating.
constexpr std::size_t kUsualDimensions = 64;

// One frame of the blend b: (1-s) w + s q, w between two frames of the source.
template <typename Number>
inline void blend_frame(const float* below, const float* above, Number fraction,
                        const float* target, Number s, std::size_t dimensions, Number* blended) {
  for (std::size_t k = 0; k < dimensions; ++k) {
    const Number lower = below[k];
    const Number warped = lower + fraction * (static_cast<Number>(above[k]) - lower);
    blended[k] = (Number(1) - s) * warped + s * static_cast<Number>(target[k]);
  }
}

// |before - 2 at + after|; `padded` numbers each, zeros from #dimensions on.
template <typename Lanes, std::size_t kLanes, typename Number>
inline Number second_difference_norm(const Number* before, const Number* at, const Number* after,
                                     std::size_t padded) {
  Lanes sum = {};
  for (std::size_t k = 0; k < padded; k += kLanes) {
    Lanes left, middle, right;
    load(left, before + k);
    load(middle, at + k);
    load(right, after + k);
    const Lanes second = (left + right) - Number(2) * middle;
    sum += second * second;
  }
  return std::sqrt(sum_of_lanes(sum));
}

// The frames of a blend, and room for three of them: `padded` numbers each, zeros.
template <typename Number>
struct BlendInput {
  const float* source;
  std::int32_t source_count;
  const float* target;
  std::int32_t target_count;
  std::size_t dimensions;
  std::size_t padded;
  Number* room;
};

// Sum over the blend's inner frames of the norm of its second difference; ends early above `limit`.
template <typename Lanes, std::size_t kLanes, typename Number>
[[gnu::always_inline]] inline Number summed_norms_of_blend(const BlendInput<Number>& blend,
                                                           Number limit) {
  const std::int32_t last = blend.target_count - 1;
  Number sum = 0;
  for (std::int32_t m = 0; m <= last && sum <= limit; ++m) {
    const double s = static_cast<double>(m) / last;
    const double u = s * (blend.source_count - 1);
    const std::int32_t below = std::min(static_cast<std::int32_t>(u), blend.source_count - 1);
    const std::int32_t above = std::min(below + 1, blend.source_count - 1);
    const auto frame = [&](std::int32_t i) {
      return blend.room + static_cast<std::size_t>(i % 3) * blend.padded;
    };
    blend_frame(blend.source + static_cast<std::size_t>(below) * blend.dimensions,
                blend.source + static_cast<std::size_t>(above) * blend.dimensions,
                static_cast<Number>(u - below),
                blend.target + static_cast<std::size_t>(m) * blend.dimensions,
                static_cast<Number>(s), blend.dimensions, frame(m));
    if (m >= 2) {
      sum +=
          second_difference_norm<Lanes, kLanes>(frame(m - 2), frame(m - 1), frame(m), blend.padded);
    }
  }
  return sum;
}

PHONOMIME_DISPATCHED
double summed_second_differences(const BlendInput<double>& blend, double limit) {
  return summed_norms_of_blend<DoubleLanes, kDoubleLanes>(blend, limit);
}

// The same in single precision.
PHONOMIME_DISPATCHED
float rough_second_differences(const BlendInput<float>& blend, float limit) {
  return summed_norms_of_blend<FloatLanes, kFloatLanes>(blend, limit);
}

} // namespace

// In single precision a number of a blend is off by at most 13 roundings of the largest number it
// comes from, a second difference by 58; those are of nine frames at most, so that their norms are
// at most three times that of the largest.
JoinCost::JoinCost(const MotionTable& table, const CostWeights& weights, double largest_frame)
    : table_(table), weights_(weights), blend_margin_(3.0 * 58.0 * 0x1p-24 * largest_frame),
      poses_(table, weights) {}

double JoinCost::position_gap(NodeIndex from, NodeIndex to) const {
  return summed_group_norms(poses_.last(from), poses_.first(to), poses_.group_stride(),
                            poses_.channels_per_group());
}

double JoinCost::velocity_gap(NodeIndex from, NodeIndex to) const {
  const std::size_t velocity = poses_.velocity_offset();
  return summed_group_norms(poses_.last(from) + velocity, poses_.first(to) + velocity,
                            poses_.group_stride(), poses_.channels_per_group());
}

// Sum over the inner frames of E6's blend by `kernel`, which takes lanes of `kLanes` numbers; 0
// under three frames.
template <typename Number, std::size_t kLanes, typename Kernel>
Number JoinCost::summed_smoothing(NodeIndex from, NodeIndex target, const Kernel& kernel) const {
  const MotionNode& source = table_.nodes[static_cast<std::size_t>(from)];
  const MotionNode& q = table_.nodes[static_cast<std::size_t>(target)];
  if (q.frame_count < 3) {
    return 0;
  }
  const auto dimensions = static_cast<std::size_t>(table_.coefficients.cols());
  const std::size_t padded = (dimensions + kLanes - 1) / kLanes * kLanes;
  std::array<Number, 3 * kUsualDimensions> usual{};
  std::vector<Number> large(padded > kUsualDimensions ? 3 * padded : 0);
  return kernel(
      BlendInput<Number>{table_.coefficients.row(source.first_frame).data(), source.frame_count,
                         table_.coefficients.row(q.first_frame).data(), q.frame_count, dimensions,
                         padded, large.empty() ? usual.data() : large.data()});
}

double JoinCost::direct_smoothing_cost(NodeIndex from, NodeIndex target) const {
  return table_.rate_hz *
         summed_smoothing<double, kDoubleLanes>(from, target, [](const auto& blend) {
           return summed_second_differences(blend, std::numeric_limits<double>::infinity());
         });
}

double JoinCost::smoothing_floor(double limit, NodeIndex from, NodeIndex to) const {
  const NodeIndex before = table_.nodes[static_cast<std::size_t>(to)].predecessor;
  const double scale = weights_.alpha2 * table_.rate_hz;
  if (scale == 0.0) {
    return 0.0;
  }
  const double frames = table_.nodes[static_cast<std::size_t>(before)].frame_count;
  const double share = kRelativeMargin + 0x1p-24 * frames;
  const auto margin = [&](double sum) { return share * sum + frames * blend_margin_; };
  const double most = limit / scale; // of the sum less its margin
  const auto enough = static_cast<float>((most + margin(most)) * (1.0 + 2.0 * share));
  const auto sum = static_cast<double>(summed_smoothing<float, kFloatLanes>(
      from, before, [&](const auto& blend) { return rough_second_differences(blend, enough); }));
  return scale * std::max(0.0, sum - margin(sum));
}

double JoinCost::gaps(NodeIndex from, NodeIndex to) const {
  return weights_.alpha3 * position_gap(from, to) + velocity_gap(from, to);
}

// Every operation of rough_group_norms() is right to 2^-24 of its own result, and none cancels but
// the first differences, which are right to the same.
double JoinCost::gaps_floor(NodeIndex from, NodeIndex to) const {
  const auto norms = [&](std::size_t offset) {
    return static_cast<double>(rough_group_norms(poses_.last(from) + offset,
                                                 poses_.first(to) + offset, poses_.group_stride(),
                                                 poses_.channels_per_group()));
  };
  return (weights_.alpha3 * norms(0) + norms(poses_.velocity_offset())) * (1.0 - kRelativeMargin);
}

double JoinCost::smoothing(NodeIndex from, NodeIndex to) const {
  const NodeIndex before = table_.nodes[static_cast<std::size_t>(to)].predecessor;
  return weights_.alpha2 == 0.0 ? 0.0 : weights_.alpha2 * direct_smoothing_cost(from, before);
}

double JoinCost::ordinary_join(NodeIndex from, NodeIndex to) const {
  return smoothing(from, to) + gaps(from, to);
}

double JoinCost::transition(NodeIndex from, NodeIndex to) const {
  const NodeIndex before = table_.nodes[static_cast<std::size_t>(to)].predecessor;
  if (before == from) { // rule 1
    return 0.0;
  }
  if (before == kNoNode) { // rule 4
    return weights_.alpha1 * weights_.pnt;
  }
  const double join = ordinary_join(from, to); // rules 2 and 3
  const bool same_viseme = table_.nodes[static_cast<std::size_t>(from)].viseme ==
                           table_.nodes[static_cast<std::size_t>(before)].viseme;
  return same_viseme ? join : join + weights_.pnt;
}

} // namespace phonomime
