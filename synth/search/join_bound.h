// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/linear_features.h"
#include "synth/search/node_records.h"
#include "synth/search/search_types.h"

#include <span>

namespace phonomime {

// A lower bound of alpha3 PGap + VGap (E7) that costs a tenth of it and loses a few per cent: the
// sum, over clusters of channel groups, of the norms of the clusters' motion (motion_clusters.h).
// All rounding errors are covered by a margin.
class JoinBound {
public:
  // `largest_frame`: as largest_frame_norm().
  JoinBound(const MotionTable& table, const CostWeights& weights, double largest_frame);

  // Must have been called for both nodes of a pair before its bound is asked for.
  void ensure(std::span<const NodeIndex> nodes);

  // At most alpha3 PGap + VGap of the join from `from` to `to`; never negative. Less tight where it
  // is above `enough`.
  double gaps(NodeIndex from, NodeIndex to, double enough) const;

private:
  int axes_;
  LinearFeatures features_; // axis a of cluster c at a * 16 + c
  double margin_;
  NodeRecords records_; // first end, then last end
};

} // namespace phonomime
