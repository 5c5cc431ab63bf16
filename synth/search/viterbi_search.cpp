// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"

#include "synth/search/state_lattice.h"
#include "synth/search/thread_count.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

namespace phonomime {

namespace {

// In PNT. A good path has no node whose cost, with all that follows, is much further above the
// least of its step.
constexpr double kWindow = 1.25;

// In PNT. Active nodes that were the near ones go on to be as long as near reaches less further.
constexpr double kStillNear = 0.5;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// In PNT. Renewed bounds are made tight that far above the least of a step, then further, until
// the best path costs at most `kReach` more than they say; rough joins at pauses leave some of it.
constexpr std::array<double, 3> kWithin = {1.0, 2.0, kInfinity};
constexpr double kReach = 1.25;

// Bounds of all that follows each step, for one path after another.
class BoundsToGo {
public:
  // `further`: whether renew() is to come.
  BoundsToGo(JoinKernels& kernels, const Progress& progress, bool further)
      : recursion_(kernels, JoinFrontier::Side::later), progress_(progress), further_(further),
        near_enough_(kStillNear * kernels.cost.weights().pnt),
        window_(kWindow * kernels.cost.weights().pnt) {}

  void make(std::span<const StepPenalties> penalties, JoinFrontier::Counts& counts) {
    steps_.assign(penalties.size(), {});
    kept_.resize(further_ ? penalties.size() : 0);
    for (std::size_t t = penalties.size(); t-- > 0;) {
      make_step(t, penalties, counts);
    }
  }

  // After nodes have been taken away, and none given back. `within`: RelaxedRecursion::renew().
  void renew(std::span<const StepPenalties> penalties, double within,
             JoinFrontier::Counts& counts) {
    for (std::size_t t = penalties.size(); t-- > 0;) {
      if (penalties[t].near() > steps_[t].active_penalty + near_enough_) {
        make_step(t, penalties, counts);
      } else if (t + 1 < penalties.size()) {
        progress_.update("search", 0, static_cast<std::int64_t>(penalties.size()));
        recursion_.renew(steps_[t], kept_[t], penalties[t], steps_[t + 1], penalties[t + 1], within,
                         counts);
      }
    }
  }

  const std::vector<StepBounds>& steps() const { return steps_; }

private:
  void make_step(std::size_t t, std::span<const StepPenalties> penalties,
                 JoinFrontier::Counts& counts) {
    progress_.update("search", 0, static_cast<std::int64_t>(penalties.size()));
    steps_[t] = t + 1 == penalties.size()
                    ? recursion_.border(penalties[t])
                    : recursion_.next(penalties[t], steps_[t + 1], penalties[t + 1], counts,
                                      further_ ? &kept_[t] : nullptr, window_);
  }

  RelaxedRecursion recursion_;
  const Progress& progress_;
  bool further_;
  double near_enough_;
  double window_;
  std::vector<StepBounds> steps_;
  std::vector<KeptJoins> kept_; // per step, where further_
};

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
