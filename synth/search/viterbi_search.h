// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/search/node_classes.h"
#include "synth/search/runners_up.h"
#include "synth/search/search_types.h"

#include <span>
#include <vector>

namespace phonomime {

struct SearchOptions {
  int threads = 0;    // 0 = as many as there are cores; changes speed, never the result
  int runners_up = 0; // per step; exact, at the price of a second, wider pass
};

// What a search had to look at. The same for every number of threads.
struct SearchCounts {
  std::int64_t transitions = 0; // transition costs computed in full
  std::int64_t bounds = 0;      // lower bounds computed
  std::int64_t states = 0;      // (step, node) pairs that could not be excluded
};

struct SearchResult {
  NodePath path;
  std::vector<std::vector<RunnerUp>> runners_up; // per step, best first; empty unless asked for
  SearchCounts counts;
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
  ViterbiSearch(const MotionTable& table, const CostWeights& weights);

  // No step, no path: cost 0. Throws Interrupted where `progress` asks for a stop.
  SearchResult solve(std::span<const SearchStep> steps, const SearchOptions& options = {},
                     const Progress& progress = {});

private:
  const MotionTable& table_;
  CostWeights weights_;
  NodeClasses classes_;
  JoinKernels kernels_;
};

} // namespace phonomime
