// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/boundary_poses.h"
#include "synth/search/linear_features.h"
#include "synth/search/search_types.h"

#include <cstddef>
#include <span>

namespace phonomime {

// The transition cost TC(from, to) of E Table I with E6 to E9, in mm/s (or weight/s). Sums over
// groups and over dimensions run in four lanes, element k in lane k mod 4, joined as
// (lane0 + lane1) + (lane2 + lane3): the same bytes with every instruction set.
class JoinCost {
public:
  JoinCost(const MotionTable& table, const CostWeights& weights)
      : JoinCost(table, weights, largest_frame_norm(table)) {}
  // `largest_frame`: as largest_frame_norm().
  JoinCost(const MotionTable& table, const CostWeights& weights, double largest_frame);

  // Must have been called for every node of a pair before transition() is.
  void ensure(std::span<const NodeIndex> nodes) { poses_.ensure(nodes); }

  double transition(NodeIndex from, NodeIndex to) const;

  // Rules 2 and 3 without their penalty: alpha2 DSC + alpha3 PGap + VGap, where `to` has a
  // predecessor that is not `from`.
  double ordinary_join(NodeIndex from, NodeIndex to) const;

  // Its two parts, for a caller that can do without the second: E7 and alpha2 E6.
  double gaps(NodeIndex from, NodeIndex to) const;
  double smoothing(NodeIndex from, NodeIndex to) const;

  // At most smoothing(), by about 1e-5 of it and a little, in half its time; where it is above
  // `limit`, something above about that limit.
  double smoothing_floor(double limit, NodeIndex from, NodeIndex to) const;

  // At most gaps(), by about 1e-5 of it, in a third of its time.
  double gaps_floor(NodeIndex from, NodeIndex to) const;

  // E8 and E9: sums over groups of |first(to) - last(from)|.
  double position_gap(NodeIndex from, NodeIndex to) const;
  double velocity_gap(NodeIndex from, NodeIndex to) const;

  // E6 as DESIGN 4 reads it: rate * sum |b[m+1] - 2 b[m] + b[m-1]|, b(s) = (1-s) w + s q, q the
  // frames of `target`, w those of `from` resampled linearly to as many. 0 under three frames.
  double direct_smoothing_cost(NodeIndex from, NodeIndex target) const;

  const CostWeights& weights() const { return weights_; }
  const MotionTable& table() const { return table_; }

private:
  template <typename Number, std::size_t kLanes, typename Kernel>
  Number summed_smoothing(NodeIndex from, NodeIndex target, const Kernel& kernel) const;

  const MotionTable& table_;
  CostWeights weights_;
  double blend_margin_;
  BoundaryPoses poses_;
};

} // namespace phonomime
