// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/search/join_frontier.h"
#include "synth/search/node_classes.h"
#include "synth/search/relaxed_bounds.h"
#include "synth/search/runners_up.h"
#include "synth/search/search_types.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace phonomime {

struct SearchOptions {
  int threads = 0;    // 0 = as many as there are cores; changes speed, never the result
  int runners_up = 0; // per step; exact, at the price of a second, wider pass
};

// What a search had to look at. The same for every number of threads.
struct SearchCounts {
  std::int64_t transitions = 0; // joins that no bound without E6 could exclude
  std::int64_t bounds = 0;      // bounds of boxes and sketches computed
  std::int64_t states = 0;      // (step, node) pairs that could not be excluded
};

struct SearchResult {
  NodePath path;
  std::vector<std::vector<RunnerUp>> runners_up; // per step, best first; empty unless asked for
  SearchCounts counts;
};

// What all searches of one table by one set of weights share, and keep of nodes between them.
struct SearchSpace {
  // Throws InputError for weights outside their range and a table without nodes.
  SearchSpace(const MotionTable& motion_table, const CostWeights& cost_weights);

  // Not for parallel regions. The steps must outlive it.
  std::vector<StepPenalties> penalties(std::span<const SearchStep> steps);

  const MotionTable& table;
  CostWeights weights;
  NodeClasses classes;
  ContextFit fit;
  JoinKernels kernels;
};

// Covers the rounding of sums of bounds, which are associated differently from exact costs.
inline double with_rounding(double cost) {
  return cost * (1.0 + 1e-9) + 1e-9;
}

// Bounds of all that follows each step, good for paths up to a cost.
using BoundsWithin = std::function<std::vector<StepBounds>(double budget)>;

// The forward pass of Algorithm 1 over the states that bounds leave possible, its best path, and
// the runners-up where they are asked for. `upper_bound`: of the optimum; any will do, a near one
// is fast. Where the optimum is above it the path is empty. Adds to `counts`.
SearchResult exact_search(SearchSpace& space, std::span<const SearchStep> steps,
                          std::span<const StepPenalties> penalties, double upper_bound,
                          const BoundsWithin& bounds, const SearchOptions& options,
                          const Progress& progress, JoinFrontier::Counts counts);

} // namespace phonomime
