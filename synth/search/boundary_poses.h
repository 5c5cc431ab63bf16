// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/node_records.h"
#include "synth/search/search_types.h"

#include <span>

namespace phonomime {

// The poses and velocities at the two ends of motion nodes, which E8 and E9 compare. From the E11
// reconstruction in double, ((mean + e0 c0) + e1 c1) + ..., rounded to float once. A velocity is
// the one-sided difference inside the node times the rate, in mm/s (or weight/s); 0 for one frame.
// Basis rows are times the weight of their group (group_weights.h).
//
// Kept only for the nodes asked for: a database of 80,000 nodes would need 350 MB for all.
class BoundaryPoses {
public:
  BoundaryPoses(const MotionTable& table, const CostWeights& weights);

  // Computes what is not yet there for these nodes. Not for parallel regions (it has its own).
  void ensure(std::span<const NodeIndex> nodes);

  // #channels_per_group * 2 planes (x, y, z of the pose, then of the velocity), each of
  // group_stride() floats, padded with zeros. Only for nodes that ensure() has seen.
  const float* first(NodeIndex node) const { return records_[node]; }
  const float* last(NodeIndex node) const { return records_[node] + 2 * planes_; }

  std::size_t group_stride() const { return group_stride_; }
  std::size_t velocity_offset() const { return planes_; } // from the pose of an end, in floats
  int channels_per_group() const { return channels_per_group_; }

private:
  const MotionTable& table_;
  int channels_per_group_;
  std::size_t group_stride_;
  std::size_t planes_;   // #channels_per_group * group_stride()
  Eigen::VectorXd mean_; // in the order of the planes
  FrameMatrixD basis_;   // #dimensions by planes_
  NodeRecords records_;  // first end, then last end
};

} // namespace phonomime
