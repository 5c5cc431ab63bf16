// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/search_session.h"

#include "synth/search/state_lattice.h"
#include "synth/search/thread_count.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace phonomime {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// As RelaxedRecursion has it. Bounds are kept for the edits to come, so that at an inner pause too
// they may cost more than they save at once.
constexpr std::size_t kMany = 32768;

bool is_constrained(const SearchStep& step) {
  return !step.allowed.empty() || !step.avoided.empty();
}

SearchStep without_constraints(const SearchStep& step) {
  SearchStep free = step;
  free.allowed.clear();
  free.avoided.clear();
  return free;
}

bool same_free_step(const SearchStep& a, const SearchStep& b) {
  return a.phoneme == b.phoneme && a.viseme == b.viseme && a.emotion == b.emotion &&
         a.is_silence == b.is_silence && a.surroundings == b.surroundings;
}

// One edited transcript: bounds of the free one are admissible for it.
class PivotedSearch {
public:
  PivotedSearch(SearchSpace& space, std::span<const StepPenalties> penalties,
                std::span<const StepBounds> free_so_far, std::span<const StepBounds> free_to_go,
                std::span<const SearchStep> steps, std::size_t pivot, JoinFrontier::Counts& counts)
      : kernels_(space.kernels), penalties_(penalties), free_so_far_(free_so_far),
        free_to_go_(free_to_go), pivot_(pivot), counts_(counts) {
    const RelaxedRecursion before(kernels_, JoinFrontier::Side::earlier, kMany);
    for (std::size_t t = 0; t <= pivot_; ++t) {
      if (!is_constrained(steps[t])) {
        so_far_.push_back(free_so_far[t]);
      } else if (t == 0) {
        so_far_.push_back(before.border(penalties_[t]));
      } else {
        so_far_.push_back(before.next(
            penalties_[t], before.neighbour(so_far_[t - 1], penalties_[t - 1]), counts_));
      }
    }
    const bool is_last = pivot_ + 1 == penalties_.size();
    const RelaxedRecursion after(kernels_, JoinFrontier::Side::later, kMany);
    if (!is_constrained(steps[pivot_])) {
      to_go_at_pivot_ = free_to_go_[pivot_];
    } else {
      to_go_at_pivot_ =
          is_last ? after.border(penalties_[pivot_])
                  : after.next(penalties_[pivot_],
                               after.neighbour(free_to_go_[pivot_ + 1], penalties_[pivot_ + 1]),
                               counts_);
    }
  }

  // The cost of a real path: from the best node of the pivot along the joins that the bounds took.
  double upper_bound() const {
    const StepBounds& at = to_go_at_pivot_;
    std::vector<NodeIndex> path(penalties_.size());
    path[pivot_] = *std::ranges::min_element(at.active, {}, [&](NodeIndex node) {
      return so_far_[pivot_][node] + penalties_[pivot_][node] + at[node];
    });
    const RelaxedRecursion before(kernels_, JoinFrontier::Side::earlier, kMany);
    for (std::size_t t = pivot_; t-- > 0;) {
      path[t] = before.partner(path[t + 1], so_far_[t + 1], so_far_[t], penalties_[t], counts_);
    }
    const RelaxedRecursion after(kernels_, JoinFrontier::Side::later, kMany);
    for (std::size_t t = pivot_ + 1; t < path.size(); ++t) {
      path[t] = after.partner(path[t - 1], t - 1 == pivot_ ? at : free_to_go_[t - 1],
                              free_to_go_[t], penalties_[t], counts_);
    }
    return cost_of_path(kernels_, penalties_, path, counts_);
  }

  // Bounds of all that follows each step; before the pivot only for nodes that a path within the
  // budget may have.
  std::vector<StepBounds> bounds_within(double budget) const {
    std::vector<StepBounds> bounds(free_to_go_.begin(), free_to_go_.end());
    bounds[pivot_] = to_go_at_pivot_;
    for (std::size_t t = pivot_; t-- > 0;) {
      bounds[t] = narrowed(t, bounds[t + 1], budget);
    }
    for (std::size_t t = pivot_ + 1; t < free_so_far_.size(); ++t) {
      drop_beyond(budget, free_so_far_[t], penalties_[t], bounds[t]);
    }
    return bounds;
  }

private:
  StepBounds narrowed(std::size_t t, const StepBounds& next, double budget) const {
    const StepBounds& so_far = so_far_[t];
    const StepPenalties& penalties = penalties_[t];
    double least_ahead = penalties_[t + 1].least_beyond(next.active_penalty) + next.inactive_bound;
    for (std::size_t i = 0; i < next.active.size(); ++i) {
      least_ahead = std::min(least_ahead, penalties_[t + 1][next.active[i]] + next.bound[i]);
    }
    const auto before = [&](NodeIndex node) { return so_far[node] + penalties[node]; };
    const double inactive = penalties.least_beyond(so_far.active_penalty) + so_far.inactive_bound;
    std::vector<NodeIndex> nodes =
        inactive + least_ahead <= budget ? penalties.nodes_up_to(kInfinity) : so_far.active;
    std::erase_if(nodes, [&](NodeIndex node) {
      const double cost = before(node);
      return cost == kInfinity || cost + least_ahead > budget;
    });
    std::vector<double> limits;
    std::ranges::transform(nodes, std::back_inserter(limits),
                           [&](NodeIndex node) { return budget - before(node); });
    const RelaxedRecursion after(kernels_, JoinFrontier::Side::later, kMany);
    StepBounds bounds = after.bounds_of(std::move(nodes), limits,
                                        after.neighbour(next, penalties_[t + 1]), counts_);
    bounds.active_penalty = kInfinity; // no other node can be within the budget
    bounds.inactive_bound = kInfinity;
    drop_beyond(budget, so_far, penalties, bounds);
    return bounds;
  }

  // Drops the nodes that no path within the budget can have.
  static void drop_beyond(double budget, const StepBounds& so_far, const StepPenalties& penalties,
                          StepBounds& to_go) {
    to_go.keep_if([&](NodeIndex node, double bound) {
      return so_far[node] + penalties[node] + bound <= budget;
    });
  }

  JoinKernels& kernels_;
  std::span<const StepPenalties> penalties_;
  std::span<const StepBounds> free_so_far_; // as far as they hold, at least to the pivot
  std::span<const StepBounds> free_to_go_;
  std::size_t pivot_;
  JoinFrontier::Counts& counts_;
  std::vector<StepBounds> so_far_; // up to the pivot
  StepBounds to_go_at_pivot_;
};

} // namespace

// Steps that differ from the last call's make the bounds beyond them worthless.
void SearchSession::take_over(std::span<const SearchStep> steps) {
  const bool same_length = steps.size() == free_steps_.size();
  if (!same_length) {
    so_far_.assign(steps.size(), {});
    to_go_.assign(steps.size(), {});
    so_far_valid_ = 0;
    to_go_valid_ = steps.size();
  }
  for (std::size_t t = 0; same_length && t < steps.size(); ++t) {
    if (!same_free_step(steps[t], free_steps_[t])) {
      so_far_valid_ = std::min(so_far_valid_, t);
      to_go_valid_ = std::max(to_go_valid_, t + 1);
    }
  }
  free_steps_.clear();
  std::ranges::transform(steps, std::back_inserter(free_steps_), without_constraints);
}

// Makes so_far_ hold up to the pivot, and to_go_ from it on.
void SearchSession::extend(std::size_t pivot, std::span<const StepPenalties> penalties,
                           const Progress& progress, JoinFrontier::Counts& counts) {
  const auto total = static_cast<std::int64_t>(free_steps_.size());
  const RelaxedRecursion after(space_.kernels, JoinFrontier::Side::later, kMany);
  for (; to_go_valid_ > pivot; --to_go_valid_) {
    progress.update("search", 0, total);
    const std::size_t t = to_go_valid_ - 1;
    to_go_[t] =
        t + 1 == free_steps_.size()
            ? after.border(penalties[t])
            : after.next(penalties[t], after.neighbour(to_go_[t + 1], penalties[t + 1]), counts);
  }
  const RelaxedRecursion before(space_.kernels, JoinFrontier::Side::earlier, kMany);
  for (; so_far_valid_ <= pivot; ++so_far_valid_) {
    progress.update("search", 0, total);
    const std::size_t t = so_far_valid_;
    so_far_[t] = t == 0 ? before.border(penalties[t])
                        : before.next(penalties[t],
                                      before.neighbour(so_far_[t - 1], penalties[t - 1]), counts);
  }
}

SearchResult SearchSession::solve(std::span<const SearchStep> steps, const SearchOptions& options,
                                  const Progress& progress) {
  if (steps.empty()) {
    return {};
  }
  const ThreadCount threads(options.threads);
  JoinFrontier::Counts counts;
  const bool other_length = steps.size() != free_steps_.size();
  take_over(steps);
  const std::vector<StepPenalties> free = space_.penalties(free_steps_);
  if (other_length) { // both sides whole, for the edits to come
    extend(0, free, progress, counts);
    extend(steps.size() - 1, free, progress, counts);
  }
  std::size_t pivot = std::min(to_go_valid_, steps.size() - 1);
  for (std::size_t t = pivot; t < steps.size(); ++t) {
    pivot = is_constrained(steps[t]) ? t : pivot;
  }
  extend(pivot, free, progress, counts);
  std::vector<StepPenalties> penalties;
  for (std::size_t t = 0; t < steps.size(); ++t) {
    penalties.push_back(free[t].under(steps[t]));
  }
  const PivotedSearch search(space_, penalties, std::span(so_far_).first(so_far_valid_), to_go_,
                             steps, pivot, counts);
  return exact_search(
      space_, steps, penalties, search.upper_bound(),
      [&](double budget) { return search.bounds_within(budget); }, options, progress, counts);
}

} // namespace phonomime
