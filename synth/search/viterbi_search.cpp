// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"

#include "synth/search/bounds_to_go.h"
#include "synth/search/state_lattice.h"
#include "synth/search/thread_count.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

namespace phonomime {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// In PNT. Renewed bounds are made tight that far above the least of a step, then further, until
// the best path costs at most `kReach` more than they say; rough joins at pauses leave some of it.
constexpr std::array<double, 3> kWithin = {1.0, 2.0, kInfinity};
constexpr double kReach = 1.25;

// What is known of the cost of the best path.
struct CostRange {
  double lower = 0.0;
  double upper = 0.0; // the cost of a real path
};

// The real path goes from the start of least bound along the joins that the bounds took.
CostRange cost_range(std::span<const StepBounds> to_go, JoinKernels& kernels,
                     std::span<const StepPenalties> penalties, JoinFrontier::Counts& counts) {
  const RelaxedRecursion recursion(kernels, JoinFrontier::Side::later);
  const auto value = [&](NodeIndex start) { return penalties[0][start] + to_go[0][start]; };
  std::vector<NodeIndex> path = {*std::ranges::min_element(to_go[0].active, {}, value)};
  const double lower = value(path[0]);
  for (std::size_t t = 1; t < penalties.size(); ++t) {
    path.push_back(recursion.partner(path.back(), to_go[t - 1], to_go[t], penalties[t], counts));
  }
  return {lower, cost_of_path(kernels, penalties, path, counts)};
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
  BoundsToGo to_go(space_.kernels, progress, count > 1);
  const auto range = [&](std::span<const StepPenalties> penalties) {
    return cost_range(to_go.steps(), space_.kernels, penalties, counts);
  };
  const auto search = [&](std::span<const SearchStep> asked,
                          std::span<const StepPenalties> penalties, double upper_bound,
                          int runners_up) {
    return exact_search(
        space_, asked, penalties, upper_bound, [&](double) { return to_go.steps(); },
        {.runners_up = runners_up}, progress, counts);
  };
  const std::vector<StepPenalties> free = space_.penalties(steps);
  to_go.make(free, counts);
  paths.best = search(steps, free, range(free).upper, options.runners_up);
  if (count <= 1 || (goes_on && !goes_on(paths.best.path))) {
    return paths;
  }
  std::vector<std::vector<NodeIndex>> near;
  for (const StepPenalties& penalties : free) {
    near.push_back(penalties.nodes_up_to(penalties.near()));
  }
  std::vector<NodeIndex> used = paths.best.path.nodes;
  std::vector<SearchStep> bounded(steps.begin(), steps.end()); // what to_go was made for
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
    NodePath path;
    if (std::ranges::equal(bounded, rest, avoids_no_more)) {
      const double pnt = space_.weights.pnt;
      for (const double within : kWithin) {
        to_go.renew(penalties, within == kInfinity ? within : within * pnt, counts);
        const CostRange cost = range(penalties);
        const double reach = within == kInfinity ? cost.upper : cost.lower + kReach * pnt;
        path = search(rest, penalties, std::min(cost.upper, reach), 0).path;
        if (!path.nodes.empty()) {
          break;
        }
      }
    } else {
      to_go.make(penalties, counts);
      path = search(rest, penalties, range(penalties).upper, 0).path;
    }
    paths.others.push_back(std::move(path));
    used.insert(used.end(), paths.others.back().nodes.begin(), paths.others.back().nodes.end());
    bounded = std::move(rest);
  }
  return paths;
}

} // namespace phonomime
