// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"
#include "db/types/stored_sentence.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace phonomime {

// What is kept of a node to compare it with the others of its phoneme cluster.
struct NodeMeasures {
  std::string cluster; // speaker and phoneme: nodes are compared within
  std::size_t sentence = 0;
  double duration_s = 0.0;
  double step = 0.0;      // largest step of a group from one frame to the next, times what is usual
  double step_size = 0.0; // the same in mm or weight
  int step_group = -1;
  Eigen::Index step_frame = 0; // of the sentence: the later of the two
  Eigen::VectorXf first, last; // boundary poses on the groups of pose_groups
  bool has_gap = false;        // what bridges a gap is no motion: only its duration is judged
  bool left_out = false;       // with a gap or pruned: no measure for others
};

// The groups on which boundary poses are compared: every n-th, 16 at most, so that a cluster of
// thousands can be compared with itself.
std::vector<int> pose_groups(const Layout& layout);

// One node's value against those of its cluster: times the limit, and the figures for people.
struct ClusterVerdict {
  double score = 0.0;
  double value = 0.0;
  double usual = 0.0;             // the cluster's median
  double least = 0.0, most = 0.0; // limits; least is 0 where only too much is bad
  std::size_t count = 0;          // nodes of the cluster
};

// Verdicts by node, nothing where the cluster is too small to say (under 20 nodes), in the order of
// `nodes`. Limits are medians plus so many robust sigmas of the logarithm.
std::vector<std::optional<ClusterVerdict>> judge_durations(const std::vector<NodeMeasures>& nodes);
std::vector<std::optional<ClusterVerdict>> judge_steps(const std::vector<NodeMeasures>& nodes);

// The distance of a boundary pose from the nearest one of another sentence (root mean square over
// the groups, mm or weight); `last` says that it is the last frame's.
struct PoseVerdict {
  ClusterVerdict verdict;
  bool last = false;
};
std::vector<std::optional<PoseVerdict>> judge_poses(const std::vector<NodeMeasures>& nodes,
                                                    LayoutKind kind, int threads);

} // namespace phonomime
