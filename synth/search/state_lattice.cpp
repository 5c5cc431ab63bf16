// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/state_lattice.h"

#include <algorithm>
#include <array>

namespace phonomime {

namespace {

// A node that may stand at a step, with a lower bound of the cost that follows it.
struct Candidate {
  NodeIndex node = kNoNode;
  double penalty = 0.0;
  double to_go = 0.0;
};

std::vector<Candidate> core_candidates(const LatticeInput& input, std::size_t t) {
  const StepNodes& nodes = input.nodes[t];
  std::vector<Candidate> candidates;
  candidates.reserve(nodes.core.size());
  for (std::size_t i = 0; i < nodes.core.size(); ++i) {
    candidates.push_back({nodes.core[i], nodes.core_penalty[i], input.bounds.core_to_go[t][i]});
  }
  return candidates;
}

// Candidates from which a path may stay within the budget, given the least cost of the step before.
std::vector<Candidate> possible_candidates(const LatticeInput& input, std::size_t t,
                                           double least_before, double budget) {
  std::vector<Candidate> candidates = core_candidates(input, t);
  std::erase_if(candidates,
                [&](const Candidate& c) { return least_before + c.penalty + c.to_go > budget; });
  for (const double penalty : input.nodes[t].rest_penalties) {
    const double to_go = input.bounds.rest_to_go[t];
    if (least_before + penalty + to_go > budget) {
      break; // ascending
    }
    for (const NodeIndex node : rest_of_step(input.table, input.classes, input.steps[t],
                                             input.kernels.cost.weights(), penalty)) {
      candidates.push_back({node, penalty, to_go});
    }
  }
  std::ranges::sort(candidates, {}, &Candidate::node);
  return candidates;
}

void ensure_nodes(const LatticeInput& input, const std::vector<Candidate>& candidates) {
  std::vector<NodeIndex> nodes;
  nodes.reserve(candidates.size());
  std::ranges::transform(candidates, std::back_inserter(nodes), &Candidate::node);
  input.kernels.ensure(nodes);
}

void append(StepStates& states, const Candidate& candidate, double cost, NodeIndex predecessor) {
  states.nodes.push_back(candidate.node);
  states.cost.push_back(cost);
  states.penalty.push_back(candidate.penalty);
  states.predecessor.push_back(predecessor);
}

StepStates first_states(const std::vector<Candidate>& candidates) {
  StepStates states;
  for (const Candidate& candidate : candidates) {
    append(states, candidate, candidate.penalty, kNoNode);
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
      append(states, candidates[j], best[j].value, best[j].node);
    }
  }
  return states;
}

} // namespace

Lattice exact_lattice(const LatticeInput& input, double budget, JoinFrontier::Counts& counts) {
  Lattice lattice;
  for (std::size_t t = 0; t < input.steps.size(); ++t) {
    input.progress.update("search", static_cast<std::int64_t>(t),
                          static_cast<std::int64_t>(input.steps.size()));
    const double least_before = t == 0 ? 0.0 : std::ranges::min(lattice.back().cost);
    const std::vector<Candidate> candidates = possible_candidates(input, t, least_before, budget);
    ensure_nodes(input, candidates);
    lattice.push_back(t == 0 ? first_states(candidates)
                             : next_states(input, lattice.back(), candidates, budget, counts));
  }
  return lattice;
}

double cost_of_relaxed_path(const LatticeInput& input, JoinFrontier::Counts& counts) {
  const auto estimate = [&](std::size_t t, std::size_t i) {
    return input.nodes[t].core_penalty[i] + input.bounds.core_to_go[t][i];
  };
  const auto place_of_best = [&](std::size_t t) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < input.nodes[t].core.size(); ++i) {
      best = estimate(t, i) < estimate(t, best) ? i : best;
    }
    return best;
  };
  std::size_t place = place_of_best(0);
  double cost = input.nodes[0].core_penalty[place];
  for (std::size_t t = 0; t + 1 < input.steps.size(); ++t) {
    const NodeIndex from = input.nodes[t].core[place];
    const NodeIndex to = input.bounds.core_successor[t][place];
    const std::vector<NodeIndex>& next = input.nodes[t + 1].core;
    place = to == kNoNode
                ? place_of_best(t + 1)
                : static_cast<std::size_t>(std::ranges::lower_bound(next, to) - next.begin());
    const std::array<NodeIndex, 2> join = {from, next[place]};
    input.kernels.ensure(join);
    ++counts.transitions;
    cost = (cost + input.kernels.cost.transition(join[0], join[1])) +
           input.nodes[t + 1].core_penalty[place];
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
    const std::vector<NodeIndex>& nodes = lattice[t].nodes;
    const auto at = static_cast<std::size_t>(std::ranges::lower_bound(nodes, node) - nodes.begin());
    node = lattice[t].predecessor[at];
  }
  for (std::size_t t = 0; t < length; ++t) {
    const MotionNode& info = input.table.nodes[static_cast<std::size_t>(path.nodes[t])];
    path.steps[t].observation =
        observation_cost(input.steps[t], info, input.kernels.cost.weights());
    path.steps[t].emotion = emotion_cost(input.steps[t], info, input.kernels.cost.weights());
    path.steps[t].transition =
        t == 0 ? 0.0 : input.kernels.cost.transition(path.nodes[t - 1], path.nodes[t]);
  }
  return path;
}

} // namespace phonomime
