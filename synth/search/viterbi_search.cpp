// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"

#include "synth/search/cost_weights.h"
#include "synth/search/state_lattice.h"

#include <algorithm>
#include <limits>

#include <omp.h>

namespace phonomime {

namespace {

// Sums of bounds and of exact costs are associated differently; this covers their rounding.
double with_rounding(double cost) {
  return cost * (1.0 + 1e-9) + 1e-9;
}

std::int64_t state_count(const Lattice& lattice) {
  std::int64_t states = 0;
  for (const StepStates& step : lattice) {
    states += static_cast<std::int64_t>(step.nodes.size());
  }
  return states;
}

// Sets OpenMP's thread count for a scope.
class ThreadCount {
public:
  explicit ThreadCount(int threads) : before_(omp_get_max_threads()) {
    if (threads > 0) {
      omp_set_num_threads(threads);
    }
  }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;
  ~ThreadCount() { omp_set_num_threads(before_); }

private:
  int before_;
};

// Widens the lattice until every step has the runners-up asked for.
std::vector<std::vector<RunnerUp>> exact_runners_up(const LatticeInput& input, const NodePath& path,
                                                    int count, JoinFrontier::Counts& counts) {
  const double step_share = path.cost / static_cast<double>(path.nodes.size());
  for (double slack = std::max(step_share, input.kernels.cost.weights().pnt);; slack *= 2.0) {
    const double budget =
        slack > 1e6 * (path.cost + input.kernels.cost.weights().pnt) || slack == 0.0
            ? std::numeric_limits<double>::infinity()
            : with_rounding(path.cost + slack);
    const Lattice lattice = exact_lattice(input, budget, counts);
    RunnersUp found = find_runners_up(input, lattice, path, count, budget, counts);
    if (found.complete || budget == std::numeric_limits<double>::infinity()) {
      return std::move(found.steps);
    }
  }
}

} // namespace

ViterbiSearch::ViterbiSearch(const MotionTable& table, const CostWeights& weights)
    : table_(table), weights_(weights), classes_(table), kernels_(table, weights) {
  check_cost_weights(weights, "cost weights");
  if (table.nodes.empty()) {
    throw InputError({.what = "the database has no motion node that a search may use",
                      .remedy = "Import a corpus with speech in it, or restore pruned nodes."});
  }
}

SearchResult ViterbiSearch::solve(std::span<const SearchStep> steps, const SearchOptions& options,
                                  const Progress& progress) {
  SearchResult result;
  if (steps.empty()) {
    return result;
  }
  const ThreadCount threads(options.threads);
  std::vector<StepPenalties> penalties;
  for (const SearchStep& step : steps) {
    penalties.emplace_back(table_, classes_, step, weights_);
  }
  JoinFrontier::Counts counts;
  const RelaxedRecursion recursion(kernels_, JoinFrontier::Side::later);
  std::vector<StepBounds> to_go(steps.size());
  to_go.back() = recursion.border(penalties.back());
  for (std::size_t t = steps.size() - 1; t-- > 0;) {
    progress.update("search", 0, static_cast<std::int64_t>(steps.size()));
    to_go[t] = recursion.next(penalties[t], to_go[t + 1], penalties[t + 1], counts);
  }
  const LatticeInput input{steps, penalties, to_go, kernels_, progress};
  const double upper_bound = cost_of_relaxed_path(input, counts);
  const Lattice lattice = exact_lattice(input, with_rounding(upper_bound), counts);
  result.path = best_path(input, lattice);
  result.counts.states = state_count(lattice);
  if (options.runners_up > 0) {
    result.runners_up = exact_runners_up(input, result.path, options.runners_up, counts);
  }
  result.counts.transitions = counts.transitions;
  result.counts.bounds = counts.bounds;
  return result;
}

} // namespace phonomime
