// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/node_records.h"
#include "synth/search/search_types.h"

#include <span>
#include <vector>

namespace phonomime {

// A lower bound of alpha3 PGap + VGap (E7) that costs a tenth of it.
//
// Groups are put into clusters. With E_k the rows of the PCA basis for group k and Q_k any
// orthogonal matrix, |E_k d| = |Q_k E_k d|, so that by the triangle inequality
//     sum over the cluster of |E_k d|  >=  |(sum over the cluster of Q_k E_k) d|.
// Q_k turns the group's motion towards that of its cluster (orthogonal Procrustes on the rows
// scaled by the standard deviations of the coefficients), so that little is lost: neighbouring
// markers move alike. The mean pose cancels in every difference. All rounding errors are covered by
// a margin.
class JoinBound {
public:
  JoinBound(const MotionTable& table, const CostWeights& weights);

  // Must have been called for every node of a pair before its bound is asked for.
  void ensure(std::span<const NodeIndex> nodes);

  // Floats of one end of a node.
  std::size_t end_floats() const { return end_floats_; }
  const float* first_end(NodeIndex node) const { return records_[node]; }
  const float* last_end(NodeIndex node) const { return records_[node] + end_floats_; }

  // bounds[i] <= alpha3 PGap + VGap between `end` and ends[i * end_floats()], one of them a
  // last_end and the other a first_end. Never negative.
  void bound(const float* end, std::span<const float> ends, std::span<float> bounds) const;

private:
  void fill_end(float* record, std::int64_t edge, std::int64_t before, std::int64_t after) const;

  const MotionTable& table_;
  double alpha3_;
  int axes_;
  std::size_t cluster_stride_;
  std::size_t end_floats_;
  FrameMatrixD projection_; // #axes * cluster_stride by #dimensions: sum of Q_k E_k per cluster
  float margin_ = 0.0f;
  NodeRecords records_;
};

} // namespace phonomime
