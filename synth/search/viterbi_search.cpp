// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"

#include "synth/search/state_lattice.h"
#include "synth/search/thread_count.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace phonomime {

namespace {

// In PNT. Bounds of an earlier search are used again as long as the path that is sought costs at
// most so much more than theirs did; beyond, new bounds are sooner made than too many states kept.
constexpr double kStillTight = 2.0;

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

// The cost of a real path, which bounds that hold but are not tight lead to: the best one by the
// few nodes of every step whose bounds are least.
double cost_by_few(SearchSpace& space, std::span<const SearchStep> steps,
                   std::span<const StepPenalties> penalties, std::span<const StepBounds> to_go,
                   const Progress& progress, JoinFrontier::Counts& counts) {
  constexpr std::size_t kFew = 64;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<StepBounds> few(to_go.begin(), to_go.end());
  for (std::size_t t = 0; t < few.size(); ++t) {
    std::vector<double> ahead;
    for (std::size_t i = 0; i < few[t].active.size(); ++i) {
      ahead.push_back(penalties[t][few[t].active[i]] + few[t].bound[i]);
    }
    const std::size_t last = std::min(kFew, ahead.size()) - 1;
    std::ranges::nth_element(ahead, ahead.begin() + static_cast<std::ptrdiff_t>(last));
    const double most = ahead[last];
    few[t].keep_if([&](NodeIndex node, double bound) {
      const double value = penalties[t][node] + bound;
      return value <= most && value < kInfinity;
    });
    few[t].active_penalty = kInfinity;
    few[t].inactive_bound = kInfinity;
  }
  const LatticeInput input{steps, penalties, few, space.kernels, progress};
  return best_path(input, exact_lattice(input, kInfinity, counts)).cost;
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

bool avoids_no_more(const SearchStep& a, const SearchStep& b) {
  return std::ranges::includes(b.avoided, a.avoided);
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
  std::vector<StepBounds> to_go;
  const auto search = [&](std::span<const SearchStep> asked,
                          std::span<const StepPenalties> penalties, double upper_bound,
                          int runners_up) {
    return exact_search(
        space_, asked, penalties, upper_bound, [&](double) { return to_go; },
        {.runners_up = runners_up}, progress, counts);
  };
  const auto solve = [&](std::span<const SearchStep> asked,
                         std::span<const StepPenalties> penalties, int runners_up) {
    to_go = bounds_to_go(space_.kernels, penalties, progress, counts);
    const std::vector<NodeIndex> path = path_along(to_go, space_.kernels, penalties, counts);
    return search(asked, penalties, cost_of_path(space_.kernels, penalties, path, counts),
                  runners_up);
  };
  const std::vector<StepPenalties> free = space_.penalties(steps);
  paths.best = solve(steps, free, options.runners_up);
  if (count <= 1 || (goes_on && !goes_on(paths.best.path))) {
    return paths;
  }
  std::vector<std::vector<NodeIndex>> near;
  for (const StepPenalties& penalties : free) {
    near.push_back(penalties.nodes_up_to(penalties.near()));
  }
  std::vector<NodeIndex> used = paths.best.path.nodes;
  double cost_of_bounds = paths.best.path.cost; // of the path that to_go was made for
  std::vector<SearchStep> bounded(steps.begin(), steps.end());
  while (static_cast<int>(paths.others.size()) + 1 < count) {
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<SearchStep> rest;
    for (std::size_t t = 0; t < steps.size(); ++t) {
      rest.push_back(without(steps[t], used, near[t]));
    }
    // Later paths have dearer nodes, which have to count as near then.
    const double dearer =
        paths.others.empty() ? 0.0 : paths.others.back().cost - paths.best.path.cost;
    std::vector<StepPenalties> penalties;
    for (std::size_t t = 0; t < steps.size(); ++t) {
      penalties.push_back(free[t].under(rest[t], dearer / static_cast<double>(steps.size())));
    }
    // Bounds of an earlier search go on to hold where bans have only been added.
    double upper_bound = std::numeric_limits<double>::infinity();
    if (std::ranges::equal(bounded, rest, avoids_no_more)) {
      upper_bound = cost_by_few(space_, rest, penalties, to_go, progress, counts);
    }
    if (upper_bound - cost_of_bounds <= kStillTight * space_.weights.pnt) {
      paths.others.push_back(search(rest, penalties, upper_bound, 0).path);
    } else {
      paths.others.push_back(solve(rest, penalties, 0).path);
      cost_of_bounds = paths.others.back().cost;
      bounded = rest;
    }
    used.insert(used.end(), paths.others.back().nodes.begin(), paths.others.back().nodes.end());
  }
  return paths;
}

} // namespace phonomime
