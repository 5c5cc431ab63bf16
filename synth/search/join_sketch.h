// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

#include <cstddef>
#include <vector>

namespace phonomime {

// Which ends of nodes meet in a join: the last ones of what comes before, the first ones of what
// comes after.
enum class NodeEnd { first, last };

// The two ends of every motion node as a few numbers whose city-block distance is a lower bound of
// alpha3 PGap + VGap (E7): rough, but cheap enough to look at every pair, and a box around many
// ends bounds them all (docs/search_bounds.md).
//
// Per cluster of channel groups (motion_clusters.h), y = V' P d along the principal axes of the
// cluster's motion; for weights w with |w| = 1 the Cauchy-Schwarz inequality gives
//     |P d| = |y| >= sum over axes of w_a |y_a|,
// and w proportional to the standard deviations loses least.
class JoinSketch {
public:
  static constexpr std::size_t kFeatures = 32;

  // `largest_frame`: as largest_frame_norm().
  JoinSketch(const MotionTable& table, const CostWeights& weights, double largest_frame);

  // kFeatures floats.
  const float* end(NodeEnd which, NodeIndex node) const {
    return (which == NodeEnd::first ? first_ : last_).data() +
           static_cast<std::size_t>(node) * kFeatures;
  }

  // All nodes of the table, those whose ends `which` are alike near each other: by the viseme that
  // their joins are judged by (that of the predecessor for first ends), phoneme and emotion, and
  // within these by halving along the widest feature.
  const std::vector<NodeIndex>& order(NodeEnd which) const {
    return which == NodeEnd::first ? first_order_ : last_order_;
  }
  // Place of each node in order().
  const std::vector<std::int32_t>& rank(NodeEnd which) const {
    return which == NodeEnd::first ? first_rank_ : last_rank_;
  }

  // A city-block distance, or one to a box, less 1e-5 of it and this much is certain to be at most
  // alpha3 PGap + VGap.
  double margin() const { return margin_; }

private:
  std::vector<float> first_, last_; // #nodes by kFeatures
  std::vector<NodeIndex> first_order_, last_order_;
  std::vector<std::int32_t> first_rank_, last_rank_;
  double margin_ = 0.0;
};

// The viseme by which E Table I judges a join at this end of a node: rules 2 and 3 compare that of
// the earlier node with that of the later one's predecessor. -1 for a first end without one.
std::int32_t join_viseme(const MotionTable& table, NodeEnd which, NodeIndex node);

} // namespace phonomime
