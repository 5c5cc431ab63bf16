// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/neighbour_graph.h"
#include "isomap/point_scan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

namespace phonomime {

namespace {

// Which components have grown together.
class Merger {
public:
  explicit Merger(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t component) const {
    while (parent_[component] != component) {
      component = parent_[component];
    }
    return component;
  }
  // False where they were one already. The smaller number stays.
  bool merge(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

private:
  std::vector<std::size_t> parent_;
};

bool is_before(const PointPair& x, const PointPair& y) {
  return std::tie(x.length, x.a, x.b) < std::tie(y.length, y.a, y.b);
}

} // namespace

// Boruvka's minimum spanning tree over the components. Component 0, the largest, waits to be found,
// so that no round looks from most of the points.
std::vector<PointPair> joining_edges(const FrameMatrix& points, const Components& components,
                                     int threads) {
  std::vector<PointPair> edges;
  const std::size_t count = components.sizes.size();
  if (count < 2) {
    return edges;
  }
  const PointScan scan(points);
  Merger merger(count);
  std::vector<std::size_t> group(components.of_point.size()); // of each point, by now
  while (edges.size() + 1 < count) {
    std::vector<std::int32_t> queries;
    for (std::size_t i = 0; i < group.size(); ++i) {
      group[i] = merger.find(static_cast<std::size_t>(components.of_point[i]));
      if (group[i] != 0) {
        queries.push_back(static_cast<std::int32_t>(i));
      }
    }
    const auto lists = scan.nearest(queries, 1, threads, [&](std::int32_t a, std::int32_t b) {
      return group[static_cast<std::size_t>(a)] != group[static_cast<std::size_t>(b)];
    });
    std::vector<std::optional<PointPair>> shortest(count);
    for (std::size_t q = 0; q < queries.size(); ++q) {
      const Candidate& nearest = lists[q].candidates().front();
      const PointPair pair = {std::min(queries[q], nearest.index),
                              std::max(queries[q], nearest.index), std::sqrt(nearest.distance_sq)};
      std::optional<PointPair>& best = shortest[group[static_cast<std::size_t>(queries[q])]];
      if (!best || is_before(pair, *best)) {
        best = pair;
      }
    }
    for (const std::optional<PointPair>& pair : shortest) {
      if (pair &&
          merger.merge(
              static_cast<std::size_t>(components.of_point[static_cast<std::size_t>(pair->a)]),
              static_cast<std::size_t>(components.of_point[static_cast<std::size_t>(pair->b)]))) {
        edges.push_back(*pair);
      }
    }
  }
  return edges;
}

} // namespace phonomime
