// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

struct ReferenceOptions {
  int dimensions = 4; // of the PCA, as cross-mapping uses them (X section 5)
  int extremes = 10;  // an emotion (X section 4)

  // Throws UsageError.
  void validate() const;
};

// A frame proposed for a pair, and what it stands for.
struct ProposedFrame {
  NodeIndex node = kNoNode;
  std::int32_t frame = 0; // of the node
  bool extreme = false;   // else: the middle frame of a node of its viseme and emotion
};

// How well some frames stand for all frames of the nodes (X's future work: "quantitatively measure
// the coverage of reference mocap frames"). Distances are to the nearest of them, in the PCA's
// leading dimensions, root of the sum of squares over all channels (mm, or weights).
struct ReferenceCoverage {
  // Share of the frames' variance that is left out by giving each the place of its nearest
  // reference, taken from 1: 0 = no better than one at the mean, 1 = every frame is one.
  double explained = 0.0;
  double median = 0.0, percentile_95 = 0.0, farthest = 0.0;
  NodeIndex farthest_node = kNoNode; // where the farthest frame is: what another pair would be for
  int classes = 0;                   // viseme and emotion together in the table
  int classes_met = 0;               // of them, with a reference frame
};

// One frame for each viseme and emotion that the table has nodes of, the middle frame nearest to
// the median of the middle frames; then for each emotion in turn the frames that are farthest from
// all chosen before. In order of choice; the same table gives the same frames.
std::vector<ProposedFrame> propose_references(const MotionTable& table,
                                              const ReferenceOptions& options = {});

ReferenceCoverage coverage_of(const MotionTable& table, std::span<const ProposedFrame> references,
                              int dimensions);

// Rows of `points` (#points by #dimensions) one after the other, each the farthest from all chosen
// before (`chosen`, rows too), among `among`; fewer where no other place is left.
std::vector<Eigen::Index> farthest_points(const FrameMatrixD& points,
                                          std::span<const Eigen::Index> chosen,
                                          std::span<const Eigen::Index> among, int count);

} // namespace phonomime
