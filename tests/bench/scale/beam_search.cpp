// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/beam_search.h"

#include "synth/search/step_costs.h"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

namespace phonomime::bench {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kChunk = 256; // states between two looks at what the beam still takes

struct State {
  double cost = kInfinity;
  NodeIndex node = kNoNode;
  std::size_t from = 0; // into the states of the step before
};

bool before(const State& a, const State& b) {
  return a.cost < b.cost || (a.cost == b.cost && a.node < b.node);
}

State reach(const JoinCost& cost, NodeIndex node, double own, const std::vector<State>& earlier,
            double limit) {
  State best;
  best.cost = limit;
  for (std::size_t i = 0; i < earlier.size() && earlier[i].cost + own < best.cost; ++i) {
    const double value = (earlier[i].cost + cost.transition(earlier[i].node, node)) + own;
    if (value < best.cost) {
      best = {value, node, i};
    }
  }
  return best;
}

} // namespace

NodePath beam_search(const JoinCost& cost, std::span<const SearchStep> steps, std::size_t width) {
  const MotionTable& table = cost.table();
  std::vector<std::vector<State>> beam(steps.size());
  for (std::size_t t = 0; t < steps.size(); ++t) {
    std::map<double, std::vector<NodeIndex>> by_penalty;
    for (NodeIndex node = 0; node < table.node_count(); ++node) {
      if (is_allowed(steps[t], node)) {
        const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
        by_penalty[step_penalty(steps[t], info, cost.weights())].push_back(node);
      }
    }
    std::vector<State>& kept = beam[t];
    std::vector<State> chunk(kChunk);
    double limit = kInfinity;
    const double least = t == 0 ? 0.0 : beam[t - 1].front().cost;
    for (const auto& [own, nodes] : by_penalty) {
      for (std::size_t begin = 0; begin < nodes.size() && least + own < limit; begin += kChunk) {
        const std::size_t size = std::min(kChunk, nodes.size() - begin);
#pragma omp parallel for schedule(dynamic, 16)
        for (std::size_t i = 0; i < size; ++i) {
          const NodeIndex node = nodes[begin + i];
          chunk[i] = t == 0 ? State{own, node, 0} : reach(cost, node, own, beam[t - 1], limit);
        }
        for (std::size_t i = 0; i < size; ++i) {
          if (chunk[i].node != kNoNode) {
            kept.push_back(chunk[i]);
          }
        }
        std::ranges::sort(kept, before);
        kept.resize(std::min(kept.size(), width));
        limit = kept.size() == width ? kept.back().cost : kInfinity;
      }
    }
  }
  NodePath path;
  path.cost = beam.back().front().cost;
  path.nodes.resize(steps.size());
  std::size_t state = 0;
  for (std::size_t t = steps.size(); t-- > 0;) {
    path.nodes[t] = beam[t][state].node;
    state = beam[t][state].from;
  }
  return path;
}

} // namespace phonomime::bench
