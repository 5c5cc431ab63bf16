// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/slow_exact.h"

#include "synth/search/step_costs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace phonomime::bench {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class SlowExact {
public:
  SlowExact(const MotionTable& table, const CostWeights& weights)
      : table_(table), cost_(table, weights) {
    std::vector<NodeIndex> all(table.nodes.size());
    std::iota(all.begin(), all.end(), 0);
    cost_.ensure(all);
  }

  NodePath solve(std::span<const SearchStep> steps) const;

private:
  struct Candidate {
    double cost;
    NodeIndex node;
  };
  struct Reached {
    double cost = kInfinity;
    NodeIndex from = kNoNode;
  };

  // `before` are all nodes of the step before, `candidates` the same in order of cost.
  Reached reach(NodeIndex node, double own, const std::vector<Reached>& before,
                const std::vector<Candidate>& candidates) const;

  // The orthonormal basis gives |difference of coefficients| <= PGap; a margin for the float poses.
  double least_join(NodeIndex from, NodeIndex to) const {
    const MotionNode& left = table_.nodes[static_cast<std::size_t>(from)];
    const Eigen::Index end = left.first_frame + left.frame_count - 1;
    const Eigen::Index begin = table_.nodes[static_cast<std::size_t>(to)].first_frame;
    const float norm = (table_.coefficients.row(begin) - table_.coefficients.row(end)).norm();
    return std::max(0.0, cost_.weights().alpha3 * (0.9999 * static_cast<double>(norm) - 0.01));
  }

  const MotionTable& table_;
  JoinCost cost_;
};

SlowExact::Reached SlowExact::reach(NodeIndex node, double own, const std::vector<Reached>& before,
                                    const std::vector<Candidate>& candidates) const {
  const NodeIndex captured = table_.nodes[static_cast<std::size_t>(node)].predecessor;
  Reached best;
  if (captured != kNoNode && before[static_cast<std::size_t>(captured)].cost < kInfinity) {
    best = {before[static_cast<std::size_t>(captured)].cost + own, captured};
  }
  for (const Candidate& from : candidates) {
    if (from.cost + own > best.cost) {
      break;
    }
    const bool ordinary = captured != kNoNode && captured != from.node;
    if (ordinary && (from.cost + least_join(from.node, node)) + own > best.cost) {
      continue;
    }
    const double value = (from.cost + cost_.transition(from.node, node)) + own;
    if (value < best.cost || (value == best.cost && from.node < best.from)) {
      best = {value, from.node};
    }
  }
  return best;
}

NodePath SlowExact::solve(std::span<const SearchStep> steps) const {
  const std::size_t nodes = table_.nodes.size();
  std::vector<std::vector<Reached>> reached(steps.size(), std::vector<Reached>(nodes));
  std::vector<Candidate> candidates;
  for (std::size_t t = 0; t < steps.size(); ++t) {
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto node = static_cast<NodeIndex>(i);
      if (is_allowed(steps[t], node)) {
        const double own = step_penalty(steps[t], table_.nodes[i], cost_.weights());
        reached[t][i] =
            t == 0 ? Reached{own, kNoNode} : reach(node, own, reached[t - 1], candidates);
      }
    }
    candidates.clear();
    for (std::size_t i = 0; i < nodes; ++i) {
      if (reached[t][i].cost < kInfinity) {
        candidates.push_back({reached[t][i].cost, static_cast<NodeIndex>(i)});
      }
    }
    std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
      return a.cost < b.cost || (a.cost == b.cost && a.node < b.node);
    });
  }
  NodePath path;
  path.cost = candidates.front().cost;
  path.nodes.resize(steps.size());
  NodeIndex node = candidates.front().node;
  for (std::size_t t = steps.size(); t-- > 0;) {
    path.nodes[t] = node;
    node = reached[t][static_cast<std::size_t>(node)].from;
  }
  return path;
}

} // namespace

NodePath slow_exact(const MotionTable& table, const CostWeights& weights,
                    std::span<const SearchStep> steps) {
  return SlowExact(table, weights).solve(steps);
}

} // namespace phonomime::bench
