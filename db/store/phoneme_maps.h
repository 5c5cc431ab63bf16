// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// What the database keeps of a phoneme's maps, but for the places on them. Whether they still
// belong to the database's frames is for whoever made them to say, by `made_of`.
struct StoredMapRecord {
  std::string speaker;
  std::string phoneme;
  std::string made_of; // fingerprint of the frames, their nodes and the options

  // The options.
  int neighbours = 0;        // k
  bool keep_largest = false; // of the neighbour graph's parts only the largest is on the maps
  int largest_exact = 0;     // frames; more of them use landmarks
  int landmark_count = 0;
  std::uint64_t seed = 0; // of the choice of landmarks

  // What was found.
  std::int64_t nodes = 0, frames = 0; // of the phoneme; not all frames need be on the maps
  std::int64_t components = 0;        // of the neighbour graph
  std::int64_t landmarks = 0;         // 0: every frame is one
  std::int64_t far_frames = 0;        // much farther from all others than is usual
  double isomap_residual_variance = 0.0, pca_residual_variance = 0.0; // 0 to 1
  std::int64_t placed = 0;                                            // frames on the maps
};

// A phoneme's maps: of all frames of one phoneme of one speaker, in order of their nodes' keys, but
// those of pruned nodes and nodes with gaps.
struct StoredMap {
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

  StoredMapRecord record;
  std::vector<std::int32_t> kept; // #placed, into the frames, ascending
  Places isomap;                  // #placed by 2, in the unit of the PCA coefficients
  Places pca;                     // #placed by 2
};

} // namespace phonomime
