// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"

#include "synth/search/state_lattice.h"
#include "synth/search/thread_count.h"

#include <algorithm>
#include <iterator>

namespace phonomime {

namespace {

// Bounds of all that follows each step.
std::vector<StepBounds> bounds_to_go(JoinKernels& kernels, std::span<const StepPenalties> penalties,
                                     const Progress& progress, JoinFrontier::Counts& counts) {
  const RelaxedRecursion recursion(kernels, JoinFrontier::Side::later);
  std::vector<StepBounds> to_go(penalties.size());
  to_go.back() = recursion.border(penalties.back());
  for (std::size_t t = penalties.size() - 1; t-- > 0;) {
    progress.update("search", 0, static_cast<std::int64_t>(penalties.size()));
    to_go[t] = recursion.next(penalties[t], to_go[t + 1], penalties[t + 1], counts);
  }
  return to_go;
}

// A real path: from the start of least bound along the joins that the bounds took.
std::vector<NodeIndex> path_along(std::span<const StepBounds> to_go, JoinKernels& kernels,
                                  std::span<const StepPenalties> penalties,
                                  JoinFrontier::Counts& counts) {
  const RelaxedRecursion recursion(kernels, JoinFrontier::Side::later);
  std::vector<NodeIndex> path = {*std::ranges::min_element(
      to_go[0].active, {}, [&](NodeIndex start) { return penalties[0][start] + to_go[0][start]; })};
  for (std::size_t t = 1; t < penalties.size(); ++t) {
    path.push_back(recursion.partner(path.back(), to_go[t - 1], to_go[t], penalties[t], counts));
  }
  return path;
}

// `step` without the nodes in `used` (ascending), unless that would leave none of `near`.
SearchStep without(const SearchStep& step, std::span<const NodeIndex> used,
                   std::span<const NodeIndex> near) {
  SearchStep rest = step;
  rest.avoided.clear();
  std::ranges::set_union(step.avoided, used, std::back_inserter(rest.avoided));
  const bool any =
      std::ranges::any_of(near, [&](NodeIndex node) { return is_allowed(rest, node); });
  return any ? rest : step;
}

} // namespace

SearchResult ViterbiSearch::solve(std::span<const SearchStep> steps, const SearchOptions& options,
                                  const Progress& progress) {
  return solve_disjoint(steps, 1, options, progress).best;
}

DisjointPaths ViterbiSearch::solve_disjoint(std::span<const SearchStep> steps, int count,
                                            const SearchOptions& options, const Progress& progress,
                                            const std::function<bool(const NodePath&)>& goes_on) {
  DisjointPaths paths;
  if (steps.empty()) {
    return paths;
  }
  const ThreadCount threads(options.threads);
  JoinFrontier::Counts counts;
  const auto solve = [&](std::span<const SearchStep> asked,
                         std::span<const StepPenalties> penalties, const SearchOptions& wanted) {
    const std::vector<StepBounds> to_go = bounds_to_go(space_.kernels, penalties, progress, counts);
    const std::vector<NodeIndex> path = path_along(to_go, space_.kernels, penalties, counts);
    const double upper_bound = cost_of_path(space_.kernels, penalties, path, counts);
    return exact_search(
        space_, asked, penalties, upper_bound, [&](double) { return to_go; }, wanted, progress,
        counts);
  };
  const std::vector<StepPenalties> free = space_.penalties(steps);
  paths.best = solve(steps, free, options);
  if (count <= 1 || (goes_on && !goes_on(paths.best.path))) {
    return paths;
  }
  std::vector<std::vector<NodeIndex>> near;
  for (const StepPenalties& penalties : free) {
    near.push_back(penalties.nodes_up_to(penalties.near()));
  }
  std::vector<NodeIndex> used = paths.best.path.nodes;
  while (static_cast<int>(paths.others.size()) + 1 < count) {
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<SearchStep> rest;
    for (std::size_t t = 0; t < steps.size(); ++t) {
      rest.push_back(without(steps[t], used, near[t]));
    }
    std::vector<StepPenalties> penalties;
    for (std::size_t t = 0; t < steps.size(); ++t) {
      penalties.push_back(free[t].under(rest[t]));
    }
    paths.others.push_back(solve(rest, penalties, {.threads = options.threads}).path);
    used.insert(used.end(), paths.others.back().nodes.begin(), paths.others.back().nodes.end());
  }
  return paths;
}

} // namespace phonomime
