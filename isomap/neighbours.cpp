// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/neighbours.h"

#include "isomap/point_scan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace phonomime {

Neighbours nearest_neighbours(const FrameMatrix& points, int k, int threads) {
  Neighbours neighbours;
  const auto point_count = static_cast<std::int32_t>(points.rows());
  neighbours.count = std::clamp(k, 0, std::max(0, point_count - 1));
  if (neighbours.count == 0) {
    return neighbours;
  }
  std::vector<std::int32_t> queries(static_cast<std::size_t>(point_count));
  std::iota(queries.begin(), queries.end(), 0);
  const auto lists = PointScan(points).nearest(queries, neighbours.count, threads,
                                               [](std::int32_t, std::int32_t) { return true; });
  neighbours.index.reserve(queries.size() * static_cast<std::size_t>(neighbours.count));
  neighbours.distance.reserve(neighbours.index.capacity());
  for (const NearestList& list : lists) {
    for (const Candidate& candidate : list.candidates()) {
      neighbours.index.push_back(candidate.index);
      neighbours.distance.push_back(std::sqrt(candidate.distance_sq));
    }
  }
  return neighbours;
}

} // namespace phonomime
