// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "isomap/neighbours.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// An edge between two points, from the smaller index to the larger.
struct PointPair {
  std::int32_t a = 0, b = 0;
  double length = 0.0;
};

// Points and their neighbours, in both directions.
class NeighbourGraph {
public:
  struct Edge {
    std::int32_t target = 0;
    double length = 0.0;
  };

  // Two points are neighbours where one is among the nearest of the other. `extra` edges too.
  NeighbourGraph(std::int32_t point_count, const Neighbours& neighbours,
                 std::span<const PointPair> extra = {});

  std::int32_t point_count() const { return static_cast<std::int32_t>(first_.size()) - 1; }
  std::size_t edge_count() const { return edges_.size() / 2; }

  // In order of target.
  std::span<const Edge> edges_of(std::int32_t point) const {
    const auto i = static_cast<std::size_t>(point);
    return std::span(edges_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

private:
  std::vector<std::size_t> first_; // #points + 1, into edges_
  std::vector<Edge> edges_;
};

// The connected parts of a graph, the largest first, ties by their first point.
struct Components {
  std::vector<std::int32_t> of_point; // #points, into `sizes`
  std::vector<std::int32_t> sizes;
};
Components find_components(const NeighbourGraph& graph);

// The edges of least length in all that make one component of all: one fewer than there are
// components, in the order in which they join. Points and graph are those of `components`; the
// length of an edge is the Euclidean distance of its points, ties go to the smaller pair. The same
// for any number of threads.
std::vector<PointPair> joining_edges(const FrameMatrix& points, const Components& components,
                                     int threads);

} // namespace phonomime
