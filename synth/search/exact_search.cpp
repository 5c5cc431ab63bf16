// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/exact_search.h"

#include "db/types/errors.h"
#include "synth/search/cost_weights.h"
#include "synth/search/state_lattice.h"

#include <algorithm>
#include <limits>

namespace phonomime {

namespace {

std::int64_t state_count(const Lattice& lattice) {
  std::int64_t states = 0;
  for (const StepStates& step : lattice) {
    states += static_cast<std::int64_t>(step.nodes.size());
  }
  return states;
}

// Widens the budget until every step has the runners-up asked for.
std::vector<std::vector<RunnerUp>>
exact_runners_up(SearchSpace& space, std::span<const SearchStep> steps,
                 std::span<const StepPenalties> penalties, const NodePath& path,
                 const BoundsWithin& bounds, int count, const Progress& progress,
                 JoinFrontier::Counts& counts) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double pnt = space.weights.pnt;
  const double step_share = path.cost / static_cast<double>(path.nodes.size());
  for (double slack = std::max(step_share, pnt);; slack *= 2.0) {
    const double budget = slack > 1e6 * (path.cost + pnt) || slack == 0.0
                              ? kInfinity
                              : with_rounding(path.cost + slack);
    const std::vector<StepBounds> to_go = bounds(budget);
    const LatticeInput input{steps, penalties, to_go, space.kernels, progress};
    const Lattice lattice = exact_lattice(input, budget, counts);
    RunnersUp found = find_runners_up(input, lattice, path, count, budget, counts);
    if (found.complete || budget == kInfinity) {
      return std::move(found.steps);
    }
  }
}

} // namespace

SearchSpace::SearchSpace(const MotionTable& motion_table, const CostWeights& cost_weights)
    : table(motion_table), weights(cost_weights), classes(motion_table),
      fit(motion_table, cost_weights), kernels(motion_table, cost_weights) {
  check_cost_weights(weights, "cost weights");
  if (table.nodes.empty()) {
    throw InputError({.what = "the database has no motion node that a search may use",
                      .remedy = "Import a corpus with speech in it, or restore pruned nodes."});
  }
}

std::vector<StepPenalties> SearchSpace::penalties(std::span<const SearchStep> steps) {
  std::vector<StepPenalties> all;
  all.reserve(steps.size());
  for (const SearchStep& step : steps) {
    all.emplace_back(table, classes, step, weights, fit);
  }
  return all;
}

SearchResult exact_search(SearchSpace& space, std::span<const SearchStep> steps,
                          std::span<const StepPenalties> penalties, double upper_bound,
                          const BoundsWithin& bounds, const SearchOptions& options,
                          const Progress& progress, JoinFrontier::Counts counts) {
  SearchResult result;
  const double budget = with_rounding(upper_bound);
  const std::vector<StepBounds> to_go = bounds(budget);
  const LatticeInput input{steps, penalties, to_go, space.kernels, progress};
  const Lattice lattice = exact_lattice(input, budget, counts);
  if (!lattice.back().nodes.empty()) {
    result.path = best_path(input, lattice);
  }
  if (result.path.cost > upper_bound) { // by rounding; a better path may have been left out
    result.path = {};
  }
  result.counts.states = state_count(lattice);
  if (options.runners_up > 0 && !result.path.nodes.empty()) {
    result.runners_up = exact_runners_up(space, steps, penalties, result.path, bounds,
                                         options.runners_up, progress, counts);
  }
  result.counts.transitions = counts.transitions;
  result.counts.bounds = counts.bounds;
  return result;
}

} // namespace phonomime
