// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "isomap/map_places.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// A motion node in a cluster: its frames are rows first to first + count - 1.
struct ClusterNode {
  NodeIndex node = kNoNode;                            // into the table's nodes
  std::int32_t emotion = 0;                            // into the table's emotions
  std::int32_t previous_phoneme = 0, next_phoneme = 0; // into the table's phonemes
  std::int32_t first = 0;
  std::int32_t count = 0;
};

// Every frame of one phoneme, node after node in order of their keys: what a phoneme-Isomap shows.
struct PhonemeCluster {
  std::int32_t phoneme = 0; // into the table's phonemes
  std::vector<ClusterNode> nodes;
  FrameMatrix frames;                   // #frames by #dimensions, PCA coefficients
  std::vector<std::int32_t> node_of;    // #frames, into `nodes`
  std::vector<std::int32_t> emotion_of; // #frames, into the table's emotions

  Eigen::Index frame_count() const { return frames.rows(); }
  // Relative time of a frame in its node (DESIGN 11): i / (n - 1), 0.5 in a node of one frame.
  double relative_time(std::int32_t frame) const;
};

// The table holds no pruned nodes, so that a cluster has none either. `phoneme`: into the table's
// phonemes; a phoneme that was not recorded gives an empty cluster.
PhonemeCluster gather_cluster(const MotionTable& table, std::int32_t phoneme);

// The frame of a node at a relative time, between two of its frames: (1 - share) a + share b.
struct TimeCorrectFrame {
  std::int32_t a = 0, b = 0; // into the cluster's frames
  double share = 0.0;
};

// The time-correct frame of every node (E section VI-A), #nodes. `relative_time` 0 to 1, taken to
// the nearer end beyond.
std::vector<TimeCorrectFrame> time_correct_frames(const PhonemeCluster& cluster,
                                                  double relative_time);

// Where they are on a map of the cluster: on the node's trajectory. #frames by 2.
MapPlaces places_of(std::span<const TimeCorrectFrame> frames, const MapPlaces& places);

// The nodes with a triphone context (E section VI-A), into the cluster's nodes, ascending.
std::vector<std::int32_t> context_correct_nodes(const PhonemeCluster& cluster,
                                                std::int32_t previous_phoneme,
                                                std::int32_t next_phoneme);

// Places for frames that are not on a map, pruned ones say: the mean of the places of the nearest
// frames that are, weighted by one over distance; a frame that is on the map as well is there.
// `points` and `places`: the map's, #points by #dimensions and by 2; `frames`: #frames by
// #dimensions. #frames by 2; all (0, 0) where the map is empty. The same for any number of threads.
MapPlaces place_frames(const FrameMatrix& points, const MapPlaces& places,
                       const FrameMatrix& frames, int threads, int neighbours = 3);

} // namespace phonomime
