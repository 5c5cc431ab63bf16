// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <map>
#include <mutex>
#include <span>
#include <vector>

namespace phonomime {

// Which node of a table is nearest to a stretch of motion, once it has been warped to the stretch's
// frames: least sum over frames of the squared Euclidean distance of PCA coefficients, which is
// that of the channels but for what the PCA cannot show of the stretch (the basis is orthonormal).
// Exact: every node is compared; the smallest index among equals. `table` must outlive it. May be
// used by several threads.
class NearestNodes {
public:
  // Throws InputError where the table has no nodes.
  explicit NearestNodes(const MotionTable& table);

  // Per stretch (#frames by #dimensions, at least one frame) the nearest node.
  std::vector<NodeIndex> find(std::span<const FrameMatrixD> stretches) const;

private:
  // Nodes of the same number of frames, as rows of one matrix.
  struct Group {
    Eigen::Index frame_count = 0;
    std::vector<NodeIndex> nodes; // increasing
    FrameMatrixD frames;          // #nodes by frame_count * #dimensions
  };

  // Per node of a group the sum of squares once it has been warped to so many frames.
  const Eigen::VectorXd& warped_squares(const Group& group, Eigen::Index frame_count) const;
  double distance_sq(NodeIndex node, const FrameMatrixD& stretch) const;

  const MotionTable& table_;
  std::vector<Group> groups_;
  mutable std::mutex mutex_;
  mutable std::map<std::pair<Eigen::Index, Eigen::Index>, Eigen::VectorXd> squares_;
};

} // namespace phonomime
