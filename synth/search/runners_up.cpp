// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/runners_up.h"

#include <algorithm>
#include <limits>

namespace phonomime {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Least cost of everything after each state of a step, over the states kept; infinite where every
// continuation is above the budget.
std::vector<double> costs_to_go(const LatticeInput& input, const StepStates& states,
                                const StepStates& next, const std::vector<double>& next_to_go,
                                double budget, JoinFrontier::Counts& counts) {
  std::vector<NodeIndex> nodes;
  std::vector<double> ahead;
  for (std::size_t j = 0; j < next.nodes.size(); ++j) {
    if (next_to_go[j] < kInfinity) {
      nodes.push_back(next.nodes[j]);
      ahead.push_back(next.penalty[j] + next_to_go[j]);
    }
  }
  const JoinFrontier frontier(JoinFrontier::Side::later, input.kernels, nodes, ahead);
  std::vector<double> to_go(states.nodes.size());
  for_each_in_parallel(to_go.size(), counts, [&](std::size_t i, JoinFrontier::Counts& own) {
    to_go[i] = frontier.best_join(states.nodes[i], 0.0, budget - states.cost[i], own).value;
  });
  return to_go;
}

} // namespace

RunnersUp find_runners_up(const LatticeInput& input, const Lattice& lattice, const NodePath& path,
                          int count, double budget, JoinFrontier::Counts& counts) {
  RunnersUp result;
  result.complete = true;
  result.steps.resize(lattice.size());
  std::vector<double> to_go(lattice.back().nodes.size(), 0.0);
  for (std::size_t t = lattice.size(); t-- > 0;) {
    const StepStates& states = lattice[t];
    if (t + 1 < lattice.size()) {
      to_go = costs_to_go(input, states, lattice[t + 1], to_go, budget, counts);
    }
    std::vector<RunnerUp>& others = result.steps[t];
    for (std::size_t i = 0; i < states.nodes.size(); ++i) {
      const double through = states.cost[i] + to_go[i];
      if (through <= budget && states.nodes[i] != path.nodes[t]) {
        others.push_back({states.nodes[i], std::max(0.0, through - path.cost)});
      }
    }
    std::ranges::sort(others, [](const RunnerUp& a, const RunnerUp& b) {
      return a.delta != b.delta ? a.delta < b.delta : a.node < b.node;
    });
    const std::int64_t wanted =
        std::min<std::int64_t>(count, input.penalties[t].allowed_count() - 1);
    result.complete = result.complete && static_cast<std::int64_t>(others.size()) >= wanted;
    others.resize(std::min(others.size(), static_cast<std::size_t>(std::max(count, 0))));
  }
  return result;
}

} // namespace phonomime
