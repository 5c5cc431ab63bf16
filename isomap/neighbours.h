// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// The nearest other points of every point: #points by `count`, nearest first. Points that are
// equally near are in order of their index.
struct Neighbours {
  int count = 0;                   // of each point: k, or all others where there are fewer
  std::vector<std::int32_t> index; // into the points
  std::vector<double> distance;    // Euclidean, in the points' unit

  std::span<const std::int32_t> of(std::size_t point) const {
    return std::span(index).subspan(point * static_cast<std::size_t>(count),
                                    static_cast<std::size_t>(count));
  }
  std::span<const double> distances_of(std::size_t point) const {
    return std::span(distance).subspan(point * static_cast<std::size_t>(count),
                                       static_cast<std::size_t>(count));
  }
};

// Exact, in double. `points`: #points by #dimensions, finite. k at least 1. The same for any number
// of threads (0: as many as there are).
Neighbours nearest_neighbours(const FrameMatrix& points, int k, int threads);

} // namespace phonomime
