// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/exact_search.h"

#include <functional>
#include <span>

namespace phonomime {

// Paths of one transcript that have no node in common, each the best without those before it.
struct DisjointPaths {
  SearchResult best;
  std::vector<NodePath> others; // in the order in which they were found
};

// The exact search for the node path of least cost (E4, Algorithm 1 with DESIGN 4).
//
// The cost is that of the plain O(N^2 T) recursion, to the bit, and so is the path: ties go to the
// smallest last node, then to the smallest predecessors. Backward over lower bounds, which also
// gives a path near the optimum and so an upper bound (relaxed_bounds.h), then forward over every
// state that the two leave possible.
//
// Keeps what it computes of nodes, so that a second search of the same table is faster. One search
// at a time; `table` must outlive it.
class ViterbiSearch {
public:
  // Throws InputError for weights outside their range and a table without nodes.
  ViterbiSearch(const MotionTable& table, const CostWeights& weights) : space_(table, weights) {}

  // No step, no path: cost 0. Throws Interrupted where `progress` asks for a stop.
  SearchResult solve(std::span<const SearchStep> steps, const SearchOptions& options = {},
                     const Progress& progress = {});

  // The best path, then the best that shares no node with it, then the best that shares none with
  // either, and so on: `count` of them. A step that has no other node near its least penalty
  // (StepPenalties::near), or among those that a `use` constraint names, keeps those of earlier
  // paths, so that neither constraint nor rare phoneme is given up. Runners-up are of the best
  // path. `goes_on` is asked once that is known: where it says no, there are no others.
  DisjointPaths solve_disjoint(std::span<const SearchStep> steps, int count,
                               const SearchOptions& options = {}, const Progress& progress = {},
                               const std::function<bool(const NodePath& best)>& goes_on = {});

  SearchSpace& space() { return space_; }

private:
  SearchSpace space_;
};

} // namespace phonomime
