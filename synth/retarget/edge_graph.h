// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/triangle_mesh.h"

#include <span>
#include <utility>
#include <vector>

namespace phonomime {

// The edges of a mesh with their lengths. Immutable; several threads may walk it at once.
class EdgeGraph {
public:
  struct Neighbour {
    int vertex = 0;
    double length = 0.0; // in the positions' unit
  };

  // Vertices that no triangle uses have no neighbour.
  EdgeGraph(const Points& positions, const Triangles& triangles);

  int vertex_count() const { return static_cast<int>(first_.size()) - 1; }
  std::span<const Neighbour> neighbours(int vertex) const;
  bool has_edge(int a, int b) const;

  // Vertices of a shortest path along edges, both ends included; empty where there is none.
  std::vector<int> shortest_path(int from, int to) const;
  double path_length(std::span<const int> path) const;

private:
  std::vector<std::size_t> first_; // #vertices + 1, into neighbours_
  std::vector<Neighbour> neighbours_;
};

// Dijkstra from one vertex or from several at once, a step at a time. The graph must outlive it.
class DijkstraWalk {
public:
  DijkstraWalk(const EdgeGraph& graph, std::span<const int> sources);
  DijkstraWalk(const EdgeGraph& graph, int source) : DijkstraWalk(graph, std::span(&source, 1)) {}

  struct Step {
    int vertex = -1; // -1 = nothing is left
    double distance = 0.0;
  };
  // The nearest vertex not yet given (the sources first); ties go to the smaller number.
  Step next();
  // On the way from its source; -1 for a source.
  int predecessor(int vertex) const { return predecessor_[static_cast<std::size_t>(vertex)]; }

private:
  const EdgeGraph& graph_;
  std::vector<double> distance_;
  std::vector<int> predecessor_;
  std::vector<std::pair<double, int>> heap_;
};

} // namespace phonomime
