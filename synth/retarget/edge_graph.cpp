// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/edge_graph.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace phonomime {

EdgeGraph::EdgeGraph(const Points& positions, const Triangles& triangles) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(static_cast<std::size_t>(triangles.rows()) * 6);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = triangles(t, corner);
      const int b = triangles(t, (corner + 1) % 3);
      edges.emplace_back(a, b);
      edges.emplace_back(b, a);
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::ranges::unique(edges).begin(), edges.end());
  first_.assign(static_cast<std::size_t>(positions.rows()) + 1, 0);
  neighbours_.reserve(edges.size());
  for (const auto& [a, b] : edges) {
    ++first_[static_cast<std::size_t>(a) + 1];
    neighbours_.push_back({b, (positions.row(a) - positions.row(b)).norm()});
  }
  for (std::size_t v = 1; v < first_.size(); ++v) {
    first_[v] += first_[v - 1];
  }
}

std::span<const EdgeGraph::Neighbour> EdgeGraph::neighbours(int vertex) const {
  const auto v = static_cast<std::size_t>(vertex);
  return std::span(neighbours_).subspan(first_[v], first_[v + 1] - first_[v]);
}

bool EdgeGraph::has_edge(int a, int b) const {
  return std::ranges::binary_search(neighbours(a), b, {}, &Neighbour::vertex);
}

std::vector<int> EdgeGraph::shortest_path(int from, int to) const {
  DijkstraWalk walk(*this, from);
  for (auto step = walk.next(); step.vertex >= 0; step = walk.next()) {
    if (step.vertex == to) {
      std::vector<int> path;
      for (int v = to; v >= 0; v = walk.predecessor(v)) {
        path.push_back(v);
      }
      std::ranges::reverse(path);
      return path;
    }
  }
  return {};
}

double EdgeGraph::path_length(std::span<const int> path) const {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto around = neighbours(path[i - 1]);
    length += std::ranges::lower_bound(around, path[i], {}, &Neighbour::vertex)->length;
  }
  return length;
}

DijkstraWalk::DijkstraWalk(const EdgeGraph& graph, std::span<const int> sources)
    : graph_(graph), distance_(static_cast<std::size_t>(graph.vertex_count()),
                               std::numeric_limits<double>::infinity()),
      predecessor_(static_cast<std::size_t>(graph.vertex_count()), -1) {
  for (const int source : sources) {
    distance_[static_cast<std::size_t>(source)] = 0.0;
    heap_.emplace_back(0.0, source);
  }
  std::ranges::make_heap(heap_, std::greater<>());
}

DijkstraWalk::Step DijkstraWalk::next() {
  while (!heap_.empty()) {
    std::ranges::pop_heap(heap_, std::greater<>());
    const auto [distance, vertex] = heap_.back();
    heap_.pop_back();
    if (distance > distance_[static_cast<std::size_t>(vertex)]) {
      continue; // a shorter way was found since
    }
    for (const auto& [neighbour, length] : graph_.neighbours(vertex)) {
      const auto n = static_cast<std::size_t>(neighbour);
      if (distance + length < distance_[n]) {
        distance_[n] = distance + length;
        predecessor_[n] = vertex;
        heap_.emplace_back(distance + length, neighbour);
        std::ranges::push_heap(heap_, std::greater<>());
      }
    }
    return {vertex, distance};
  }
  return {};
}

} // namespace phonomime
