// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace phonomime {

// The three ways of T section 3.1.2.
enum class KeyshapeMethod { extrema, hull, clusters };
inline constexpr std::array<std::string_view, 3> kKeyshapeMethodNames = {"extrema", "hull",
                                                                         "clusters"};

struct KeyshapeOptions {
  KeyshapeMethod method = KeyshapeMethod::extrema;
  int count = 20; // of keyshapes; the hull has as many as it has
  // Extrema nearer than this to one of a more dominant axis are left out: Euclidean distance, as a
  // share of the frames' root mean squared distance from their mean.
  double similar = 0.5;
  int cluster_dimensions = 3; // of the PCA, for clusters (T: 2 and 3)
  std::uint64_t seed = 1;     // of the lots that clusters begin with

  // Throws UsageError that names the value.
  void validate() const;
};

struct Keyshape {
  Eigen::Index frame = 0;
  int axis = -1;        // of extrema, the one that it is the extremum of, counted from 0
  bool largest = false; // its largest or its smallest coefficient
};

// An extremum that was left out, for it is too like another.
struct SimilarKeyshape {
  Keyshape keyshape;
  std::size_t kept = 0;  // into `chosen`: the one that stands for it
  double distance = 0.0; // of the two, in the points' unit; 0 where they are one frame
};

struct KeyshapeSelection {
  std::vector<Keyshape> chosen; // the most important first; of extrema, fewer are always the first
  std::vector<SimilarKeyshape> left_out;
};

// Frames that cover the motion (T section 3.1.2). `points`: #frames by #axes, coefficients on
// principal axes, the largest variance first.
//
// Extrema: the frame with the largest and then that with the smallest coefficient of each axis,
// from the first axis on, without those too like one kept before, until there are `count`: where
// some are left out, more than count / 2 axes are used. Ties go to the earlier frame.
KeyshapeSelection select_keyshapes(const FrameMatrixD& points, const KeyshapeOptions& options);

} // namespace phonomime
