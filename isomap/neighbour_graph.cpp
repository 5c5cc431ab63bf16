// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/neighbour_graph.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace phonomime {

NeighbourGraph::NeighbourGraph(std::int32_t point_count, const Neighbours& neighbours,
                               std::span<const PointPair> extra) {
  std::vector<PointPair> directed;
  directed.reserve(2 * (neighbours.index.size() + extra.size()));
  const auto add = [&](std::int32_t a, std::int32_t b, double length) {
    directed.push_back({a, b, length});
    directed.push_back({b, a, length});
  };
  for (std::int32_t i = 0; i < point_count && neighbours.count > 0; ++i) {
    const auto targets = neighbours.of(static_cast<std::size_t>(i));
    const auto lengths = neighbours.distances_of(static_cast<std::size_t>(i));
    for (std::size_t n = 0; n < targets.size(); ++n) {
      add(i, targets[n], lengths[n]);
    }
  }
  for (const PointPair& pair : extra) {
    add(pair.a, pair.b, pair.length);
  }
  std::sort(directed.begin(), directed.end(), [](const PointPair& x, const PointPair& y) {
    return std::tie(x.a, x.b, x.length) < std::tie(y.a, y.b, y.length);
  });
  const auto last =
      std::unique(directed.begin(), directed.end(),
                  [](const PointPair& x, const PointPair& y) { return x.a == y.a && x.b == y.b; });
  directed.erase(last, directed.end());

  first_.assign(static_cast<std::size_t>(point_count) + 1, 0);
  edges_.reserve(directed.size());
  for (const PointPair& pair : directed) {
    ++first_[static_cast<std::size_t>(pair.a) + 1];
    edges_.push_back({pair.b, pair.length});
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

Components find_components(const NeighbourGraph& graph) {
  const auto count = static_cast<std::size_t>(graph.point_count());
  std::vector<std::int32_t> found(count, -1);
  std::vector<std::int32_t> sizes, stack;
  for (std::int32_t start = 0; start < graph.point_count(); ++start) {
    if (found[static_cast<std::size_t>(start)] >= 0) {
      continue;
    }
    const auto label = static_cast<std::int32_t>(sizes.size());
    sizes.push_back(0);
    found[static_cast<std::size_t>(start)] = label;
    stack.push_back(start);
    while (!stack.empty()) {
      const std::int32_t point = stack.back();
      stack.pop_back();
      ++sizes.back();
      for (const NeighbourGraph::Edge& edge : graph.edges_of(point)) {
        if (found[static_cast<std::size_t>(edge.target)] < 0) {
          found[static_cast<std::size_t>(edge.target)] = label;
          stack.push_back(edge.target);
        }
      }
    }
  }
  // Found in order of their first point; now by size.
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  std::vector<std::int32_t> rank(sizes.size());
  Components components;
  for (std::size_t r = 0; r < order.size(); ++r) {
    rank[order[r]] = static_cast<std::int32_t>(r);
    components.sizes.push_back(sizes[order[r]]);
  }
  components.of_point.resize(count);
  std::transform(found.begin(), found.end(), components.of_point.begin(),
                 [&](std::int32_t label) { return rank[static_cast<std::size_t>(label)]; });
  return components;
}

} // namespace phonomime
