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

// At least this many dimensions of a blended frame are kept without allocating.
constexpr std::size_t kUsualDimensions = 64;

// One frame of the blend b: (1-s) w + s q, w between two frames of the source.
inline void blend_frame(const float* below, const float* above, double fraction,
                        const float* target, double s, std::size_t dimensions, double* blended) {
  for (std::size_t k = 0; k < dimensions; ++k) {
    const double lower = below[k];
    const double warped = lower + fraction * (static_cast<double>(above[k]) - lower);
    blended[k] = (1.0 - s) * warped + s * static_cast<double>(target[k]);
  }
}

// |before - 2 at + after|; `padded` numbers each, zeros from #dimensions on.
inline double second_difference_norm(const double* before, const double* at, const double* after,
                                     std::size_t padded) {
  DoubleLanes sum = {};
  for (std::size_t k = 0; k < padded; k += kDoubleLanes) {
    DoubleLanes left, middle, right;
    load(left, before + k);
    load(middle, at + k);
    load(right, after + k);
    const DoubleLanes second = (left + right) - 2.0 * middle;
    sum += second * second;
  }
  return std::sqrt(sum_of_lanes(sum));
}

// Sum over the blend's inner frames of the norm of its second difference; ends early above `limit`.
// `frames`: room for three padded frames, zeros.
PHONOMIME_DISPATCHED
double summed_second_differences(const float* source, std::int32_t source_count,
                                 const float* target, std::int32_t target_count,
                                 std::size_t dimensions, std::size_t padded, double limit,
                                 double* frames) {
  const std::int32_t last = target_count - 1;
  double sum = 0.0;
  for (std::int32_t m = 0; m <= last && sum <= limit; ++m) {
    const double s = static_cast<double>(m) / last;
    const double u = s * (source_count - 1);
    const std::int32_t below = std::min(static_cast<std::int32_t>(u), source_count - 1);
    const std::int32_t above = std::min(below + 1, source_count - 1);
    const auto frame = [&](std::int32_t i) {
      return frames + static_cast<std::size_t>(i % 3) * padded;
    };
    blend_frame(source + static_cast<std::size_t>(below) * dimensions,
                source + static_cast<std::size_t>(above) * dimensions, u - below,
                target + static_cast<std::size_t>(m) * dimensions, s, dimensions, frame(m));
    if (m >= 2) {
      sum += second_difference_norm(frame(m - 2), frame(m - 1), frame(m), padded);
    }
  }
  return sum;
}

} // namespace

JoinCost::JoinCost(const MotionTable& table, const CostWeights& weights)
    : table_(table), weights_(weights), poses_(table, weights) {}

double JoinCost::position_gap(NodeIndex from, NodeIndex to) const {
  return summed_group_norms(poses_.last(from), poses_.first(to), poses_.group_stride(),
                            poses_.channels_per_group());
}

double JoinCost::velocity_gap(NodeIndex from, NodeIndex to) const {
  const std::size_t velocity = poses_.velocity_offset();
  return summed_group_norms(poses_.last(from) + velocity, poses_.first(to) + velocity,
                            poses_.group_stride(), poses_.channels_per_group());
}

double JoinCost::summed_smoothing(NodeIndex from, NodeIndex target, double limit) const {
  const MotionNode& source = table_.nodes[static_cast<std::size_t>(from)];
  const MotionNode& q = table_.nodes[static_cast<std::size_t>(target)];
  if (q.frame_count < 3) {
    return 0.0;
  }
  const auto dimensions = static_cast<std::size_t>(table_.coefficients.cols());
  const std::size_t padded = (dimensions + kDoubleLanes - 1) / kDoubleLanes * kDoubleLanes;
  std::array<double, 3 * kUsualDimensions> usual{};
  std::vector<double> large(padded > kUsualDimensions ? 3 * padded : 0);
  return summed_second_differences(
      table_.coefficients.row(source.first_frame).data(), source.frame_count,
      table_.coefficients.row(q.first_frame).data(), q.frame_count, dimensions, padded, limit,
      large.empty() ? usual.data() : large.data());
}

double JoinCost::direct_smoothing_cost(NodeIndex from, NodeIndex target) const {
  return table_.rate_hz * summed_smoothing(from, target, std::numeric_limits<double>::infinity());
}

double JoinCost::smoothing_up_to(double limit, NodeIndex from, NodeIndex to) const {
  const NodeIndex before = table_.nodes[static_cast<std::size_t>(to)].predecessor;
  const double scale = weights_.alpha2 * table_.rate_hz;
  return scale == 0.0 ? 0.0 : scale * summed_smoothing(from, before, limit / scale);
}

double JoinCost::gaps(NodeIndex from, NodeIndex to) const {
  return weights_.alpha3 * position_gap(from, to) + velocity_gap(from, to);
}

// Every operation of rough_group_norms() is right to 2^-24 of its own result, and none cancels but
// the first differences, which are right to the same.
double JoinCost::gaps_floor(NodeIndex from, NodeIndex to) const {
  constexpr double kRelativeMargin = 1e-5;
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
