// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/streaming_search.h"

#include "db/types/errors.h"
#include "synth/search/thread_count.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace phonomime {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kWidth =
    256; // states of a step that are kept, and all that tie with the last

// The cost of the state at place `count - 1` by cost; infinite where there are fewer.
double cost_at(std::vector<double> costs, std::size_t count) {
  if (costs.size() < count) {
    return kInfinity;
  }
  const auto place = costs.begin() + static_cast<std::ptrdiff_t>(count) - 1;
  std::ranges::nth_element(costs, place);
  return *place;
}

// States for which keep(i) holds.
template <typename Keep>
StepStates filtered(const StepStates& states, const Keep& keep) {
  StepStates kept;
  for (std::size_t i = 0; i < states.nodes.size(); ++i) {
    if (keep(i)) {
      kept.append(states.nodes[i], states.penalty[i], {states.cost[i], states.predecessor[i]});
    }
  }
  return kept;
}

} // namespace

StreamingSearch::StreamingSearch(ViterbiSearch& search, int look_ahead,
                                 const SearchOptions& options)
    : space_(search.space()), look_ahead_(static_cast<std::size_t>(std::max(look_ahead, 0))),
      threads_(options.threads) {
  if (look_ahead < 0) {
    throw InputError({.what = "the look-ahead is out of range",
                      .expected = "0 or more phonemes",
                      .got = std::to_string(look_ahead)});
  }
}

StepStates StreamingSearch::first_states(const SearchStep& step) const {
  const StepPenalties penalties(space_.table, space_.classes, step, space_.weights, space_.fit);
  StepStates states;
  for (const NodeIndex node : penalties.nodes_up_to(penalties.near())) {
    states.append(node, penalties[node], {penalties[node], kNoNode});
  }
  const double most = cost_at(states.cost, kWidth);
  return filtered(states, [&](std::size_t i) { return states.cost[i] <= most; });
}

StepStates StreamingSearch::next_states(const StepStates& before, const SearchStep& step) const {
  const StepPenalties penalties(space_.table, space_.classes, step, space_.weights, space_.fit);
  const std::vector<NodeIndex> nodes = penalties.nodes_up_to(penalties.near());
  // Recorded successions cost nothing, and where they fill the width nothing dearer is needed.
  std::vector<double> recorded;
  for (std::size_t i = 0; i < before.nodes.size(); ++i) {
    const NodeIndex next = space_.table.nodes[static_cast<std::size_t>(before.nodes[i])].successor;
    if (next != kNoNode && penalties[next] < kInfinity) {
      recorded.push_back(before.cost[i] + penalties[next]);
    }
  }
  const double limit = cost_at(std::move(recorded), kWidth);
  space_.kernels.ensure(before.nodes);
  space_.kernels.ensure(nodes);
  const JoinFrontier frontier(JoinFrontier::Side::earlier, space_.kernels, before.nodes,
                              before.cost);
  std::vector<JoinFrontier::Best> best(nodes.size());
  JoinFrontier::Counts counts;
  for_each_in_parallel(nodes.size(), counts, [&](std::size_t i, JoinFrontier::Counts& own) {
    best[i] = frontier.best_join(nodes[i], penalties[nodes[i]], limit, own);
  });
  std::vector<double> costs;
  for (const JoinFrontier::Best& join : best) {
    costs.push_back(join.value);
  }
  const double most = cost_at(std::move(costs), kWidth);
  StepStates states;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (best[i].node != kNoNode && best[i].value <= most) {
      states.append(nodes[i], penalties[nodes[i]], best[i]);
    }
  }
  return states;
}

std::vector<NodeIndex> StreamingSearch::push(const SearchStep& step) {
  const ThreadCount threads(threads_);
  const StepPenalties allowed(space_.table, space_.classes, step, space_.weights,
                              space_.fit); // or throws
  steps_.push_back(step);
  const SearchStep& own = steps_.back();
  columns_.push_back(
      {&own, columns_.empty() ? first_states(own) : next_states(columns_.back().states, own)});
  if (open_count() <= look_ahead_) {
    return {};
  }
  const NodeIndex node = best_open_path().front();
  make_final(node);
  return {node};
}

// The nodes of the best path so far, at the open steps.
std::vector<NodeIndex> StreamingSearch::best_open_path() const {
  const StepStates& last = columns_.back().states;
  std::vector<NodeIndex> path(columns_.size());
  path.back() =
      last.nodes[static_cast<std::size_t>(std::ranges::min_element(last.cost) - last.cost.begin())];
  for (std::size_t k = columns_.size() - 1; k > 0; --k) {
    const StepStates& states = columns_[k].states;
    path[k - 1] = states.predecessor[states.place_of(path[k])];
  }
  if (front_is_final_) {
    path.erase(path.begin());
  }
  return path;
}

// The node of the first open step: it becomes the only state of the front column, from which the
// others go on.
void StreamingSearch::make_final(NodeIndex node) {
  if (front_is_final_) {
    columns_.pop_front();
  }
  front_is_final_ = true;
  StepStates& first = columns_.front().states;
  first = filtered(first, [&](std::size_t i) { return first.nodes[i] == node; });
  bool anew = false;
  for (std::size_t k = 1; k < columns_.size(); ++k) {
    const StepStates& before = columns_[k - 1].states;
    StepStates& states = columns_[k].states;
    StepStates kept = filtered(states, [&](std::size_t i) {
      return std::ranges::binary_search(before.nodes, states.predecessor[i]);
    });
    // Where few of the states go through the node, others do better from there, and all that
    // follows them.
    anew = anew || 2 * kept.nodes.size() < std::min(states.nodes.size(), kWidth);
    states = anew ? next_states(before, *columns_[k].step) : std::move(kept);
  }
}

std::vector<NodeIndex> StreamingSearch::finish() {
  const ThreadCount threads(threads_);
  std::vector<NodeIndex> nodes;
  while (open_count() > 0) {
    nodes.push_back(best_open_path().front());
    make_final(nodes.back());
  }
  return nodes;
}

double StreamingSearch::cost() const {
  return columns_.empty() ? 0.0 : std::ranges::min(columns_.back().states.cost);
}

double StreamingSearch::lower_bound() {
  const ThreadCount threads(threads_);
  const RelaxedRecursion recursion(space_.kernels, JoinFrontier::Side::earlier);
  JoinFrontier::Counts counts;
  const auto penalties_of = [&](std::size_t t) {
    return StepPenalties(space_.table, space_.classes, steps_[t], space_.weights, space_.fit);
  };
  for (; bounded_steps_ < steps_.size(); ++bounded_steps_) {
    const std::size_t t = bounded_steps_;
    const StepPenalties penalties = penalties_of(t);
    so_far_ = t == 0 ? recursion.border(penalties)
                     : recursion.next(penalties, recursion.neighbour(so_far_, penalties_of(t - 1)),
                                      counts);
    lower_bound_ = penalties.least_beyond(so_far_.active_penalty) + so_far_.inactive_bound;
    for (std::size_t i = 0; i < so_far_.active.size(); ++i) {
      lower_bound_ = std::min(lower_bound_, so_far_.bound[i] + penalties[so_far_.active[i]]);
    }
  }
  return lower_bound_;
}

} // namespace phonomime
