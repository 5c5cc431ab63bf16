// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_cost.h"

#include "synth/search/vector_dispatch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace phonomime {

namespace {

constexpr std::size_t kLanes = 4;

double join_lanes(const std::array<double, kLanes>& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

// Sum over groups of the Euclidean norm of b - a; planes of `stride` floats, one per axis.
PHONOMIME_DISPATCHED
double summed_group_norms(const float* a, const float* b, std::size_t stride, int axes) {
  std::array<double, kLanes> lanes{};
  for (std::size_t k = 0; k < stride; k += kLanes) {
    std::array<double, kLanes> square{};
    for (int axis = 0; axis < axes; ++axis) {
      const float* from = a + static_cast<std::size_t>(axis) * stride + k;
      const float* to = b + static_cast<std::size_t>(axis) * stride + k;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double difference = static_cast<double>(to[lane]) - static_cast<double>(from[lane]);
        square[lane] += difference * difference;
      }
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      lanes[lane] += std::sqrt(square[lane]);
    }
  }
  return join_lanes(lanes);
}

// One frame of the blend b: (1-s) w + s q, w between two frames of the source.
void blend_frame(const float* below, const float* above, double fraction, const float* target,
                 double s, Eigen::Index dimensions, double* blended) {
  for (Eigen::Index k = 0; k < dimensions; ++k) {
    const double lower = below[k];
    const double warped = lower + fraction * (static_cast<double>(above[k]) - lower);
    blended[k] = (1.0 - s) * warped + s * static_cast<double>(target[k]);
  }
}

double second_difference_norm(const double* before, const double* at, const double* after,
                              Eigen::Index dimensions) {
  std::array<double, kLanes> lanes{};
  for (Eigen::Index k = 0; k < dimensions; ++k) {
    const double second = (before[k] + after[k]) - 2.0 * at[k];
    lanes[static_cast<std::size_t>(k) % kLanes] += second * second;
  }
  return std::sqrt(join_lanes(lanes));
}

} // namespace

JoinCost::JoinCost(const MotionTable& table, const CostWeights& weights)
    : table_(table), weights_(weights), poses_(table) {}

double JoinCost::position_gap(NodeIndex from, NodeIndex to) const {
  return summed_group_norms(poses_.last(from), poses_.first(to), poses_.group_stride(),
                            poses_.channels_per_group());
}

double JoinCost::velocity_gap(NodeIndex from, NodeIndex to) const {
  const auto planes = static_cast<std::size_t>(poses_.channels_per_group());
  const std::size_t velocity = planes * poses_.group_stride();
  return summed_group_norms(poses_.last(from) + velocity, poses_.first(to) + velocity,
                            poses_.group_stride(), poses_.channels_per_group());
}

double JoinCost::direct_smoothing_cost(NodeIndex from, NodeIndex target) const {
  const MotionNode& source = table_.nodes[static_cast<std::size_t>(from)];
  const MotionNode& q = table_.nodes[static_cast<std::size_t>(target)];
  if (q.frame_count < 3) {
    return 0.0;
  }
  const Eigen::Index dimensions = table_.coefficients.cols();
  // Three frames of the blend at a time; a fixed buffer serves any usual number of dimensions.
  constexpr Eigen::Index kUsual = 64;
  std::array<double, 3 * kUsual> buffer;
  std::vector<double> large;
  double* frames = buffer.data();
  if (dimensions > kUsual) {
    large.resize(static_cast<std::size_t>(3 * dimensions));
    frames = large.data();
  }
  const float* source_frames = table_.coefficients.row(source.first_frame).data();
  const float* target_frames = table_.coefficients.row(q.first_frame).data();
  const std::int32_t last = q.frame_count - 1;
  double sum = 0.0;
  for (std::int32_t m = 0; m <= last; ++m) {
    const double s = static_cast<double>(m) / last;
    const double u = s * (source.frame_count - 1);
    const std::int32_t below = std::min(static_cast<std::int32_t>(u), source.frame_count - 1);
    const std::int32_t above = std::min(below + 1, source.frame_count - 1);
    double* at = frames + (m % 3) * dimensions;
    blend_frame(source_frames + below * dimensions, source_frames + above * dimensions, u - below,
                target_frames + m * dimensions, s, dimensions, at);
    if (m >= 2) {
      sum += second_difference_norm(frames + ((m - 2) % 3) * dimensions,
                                    frames + ((m - 1) % 3) * dimensions, at, dimensions);
    }
  }
  return sum * table_.rate_hz;
}

double JoinCost::ordinary_join(NodeIndex from, NodeIndex to) const {
  const NodeIndex before = table_.nodes[static_cast<std::size_t>(to)].predecessor;
  const double smoothing =
      weights_.alpha2 == 0.0 ? 0.0 : weights_.alpha2 * direct_smoothing_cost(from, before);
  const double gaps = weights_.alpha3 * position_gap(from, to) + velocity_gap(from, to); // E7
  return smoothing + gaps;
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
