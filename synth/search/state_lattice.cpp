// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/state_lattice.h"

#include <algorithm>
#include <limits>

namespace phonomime {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A node that may stand at a step, with a lower bound of the cost that follows it.
struct Candidate {
  NodeIndex node = kNoNode;
  double penalty = 0.0;
  double to_go = 0.0;
};

// Nodes that a path within the budget may have at step t, given the least cost of the step before.
std::vector<Candidate> possible_candidates(const LatticeInput& input, std::size_t t,
                                           double least_before, double budget) {
  const StepPenalties& penalties = input.penalties[t];
  const StepBounds& to_go = input.to_go[t];
  std::vector<Candidate> candidates;
  const auto add = [&](NodeIndex node, double bound) {
    const double penalty = penalties[node];
    if (penalty < kInfinity && least_before + penalty + bound <= budget) {
      candidates.push_back({node, penalty, bound});
    }
  };
  const double inactive = penalties.least_beyond(to_go.active_penalty) + to_go.inactive_bound;
  if (to_go.inactive_bound < kInfinity && least_before + inactive <= budget) {
    // No bound is below that of the inactive nodes.
    for (const NodeIndex node :
         penalties.nodes_up_to(budget - least_before - to_go.inactive_bound)) {
      add(node, to_go[node]);
    }
  } else {
    for (std::size_t i = 0; i < to_go.active.size(); ++i) {
      add(to_go.active[i], to_go.bound[i]);
    }
  }
  return candidates;
}

void ensure_nodes(const LatticeInput& input, const std::vector<Candidate>& candidates) {
  std::vector<NodeIndex> nodes;
  nodes.reserve(candidates.size());
  std::ranges::transform(candidates, std::back_inserter(nodes), &Candidate::node);
  input.kernels.ensure(nodes);
}

StepStates first_states(const std::vector<Candidate>& candidates) {
  StepStates states;
  for (const Candidate& candidate : candidates) {
    states.append(candidate.node, candidate.penalty, {candidate.penalty, kNoNode});
  }
  return states;
}

// Algorithm 1, lines 5 to 8, for the candidates alone; what is above the budget is dropped.
StepStates next_states(const LatticeInput& input, const StepStates& before,
                       const std::vector<Candidate>& candidates, double budget,
                       JoinFrontier::Counts& counts) {
  const JoinFrontier frontier(JoinFrontier::Side::earlier, input.kernels, before.nodes,
                              before.cost);
  std::vector<JoinFrontier::Best> best(candidates.size());
  for_each_in_parallel(candidates.size(), counts, [&](std::size_t j, JoinFrontier::Counts& own) {
    best[j] = frontier.best_join(candidates[j].node, candidates[j].penalty,
                                 budget - candidates[j].to_go, own);
  });
  StepStates states;
  for (std::size_t j = 0; j < candidates.size(); ++j) {
    if (best[j].node != kNoNode) {
      states.append(candidates[j].node, candidates[j].penalty, best[j]);
    }
  }
  return states;
}

} // namespace

void StepStates::append(NodeIndex node, double own_penalty, const JoinFrontier::Best& best) {
  nodes.push_back(node);
  cost.push_back(best.value);
  penalty.push_back(own_penalty);
  predecessor.push_back(best.node);
}

std::size_t StepStates::place_of(NodeIndex node) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(nodes, node) - nodes.begin());
}

Lattice exact_lattice(const LatticeInput& input, double budget, JoinFrontier::Counts& counts) {
  Lattice lattice;
  for (std::size_t t = 0; t < input.steps.size(); ++t) {
    input.progress.update("search", static_cast<std::int64_t>(t),
                          static_cast<std::int64_t>(input.steps.size()));
    const std::vector<Candidate> candidates =
        possible_candidates(input, t, t == 0 ? 0.0 : std::ranges::min(lattice.back().cost), budget);
    ensure_nodes(input, candidates);
    lattice.push_back(t == 0 ? first_states(candidates)
                             : next_states(input, lattice.back(), candidates, budget, counts));
    if (lattice.back().nodes.empty()) {
      break;
    }
  }
  return lattice;
}

double cost_of_path(JoinKernels& kernels, std::span<const StepPenalties> penalties,
                    std::span<const NodeIndex> path, JoinFrontier::Counts& counts) {
  kernels.ensure(path);
  double cost = penalties[0][path[0]];
  for (std::size_t t = 1; t < path.size(); ++t) {
    ++counts.transitions;
    cost = (cost + kernels.cost.transition(path[t - 1], path[t])) + penalties[t][path[t]];
  }
  return cost;
}

NodePath best_path(const LatticeInput& input, const Lattice& lattice) {
  NodePath path;
  const std::size_t length = lattice.size();
  const std::vector<double>& final_cost = lattice.back().cost;
  const auto place = std::ranges::min_element(final_cost) - final_cost.begin(); // first smallest
  path.cost = final_cost[static_cast<std::size_t>(place)];
  path.nodes.resize(length);
  path.steps.resize(length);
  NodeIndex node = lattice.back().nodes[static_cast<std::size_t>(place)];
  for (std::size_t t = length; t-- > 0;) {
    path.nodes[t] = node;
    node = lattice[t].predecessor[lattice[t].place_of(node)];
  }
  for (std::size_t t = 0; t < length; ++t) {
    const MotionNode& info =
        input.kernels.cost.table().nodes[static_cast<std::size_t>(path.nodes[t])];
    path.steps[t].observation =
        observation_cost(input.steps[t], info, input.kernels.cost.weights());
    path.steps[t].emotion = emotion_cost(input.steps[t], info, input.kernels.cost.weights());
    path.steps[t].fit = input.penalties[t].fit_of(path.nodes[t]);
    path.steps[t].transition =
        t == 0 ? 0.0 : input.kernels.cost.transition(path.nodes[t - 1], path.nodes[t]);
  }
  return path;
}

} // namespace phonomime
