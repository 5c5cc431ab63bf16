// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_bound.h"
#include "synth/search/join_cost.h"

#include <limits>
#include <span>
#include <vector>

namespace phonomime {

// The joins between one step's candidates and single nodes of the neighbouring step, cheapest
// first.
//
// A frontier holds candidates with the cost of everything on their side, sorted by that cost, and
// the ends of their motion in one run of memory. A join's bound is never above its cost, and each
// sum below is associated as the exact one is, so that rounding cannot turn a bound into a cut.
class JoinFrontier {
public:
  enum class Side {
    earlier, // candidates are left behind: their last ends meet the first end of a later node
    later    // candidates are ahead: their first ends meet the last end of an earlier node
  };

  // `nodes` ascending, with `values` (finite). Both kernels must know every node of the search.
  JoinFrontier(Side side, const JoinCost& cost, const JoinBound& bound,
               std::span<const NodeIndex> nodes, std::span<const double> values);

  struct Best {
    double value = std::numeric_limits<double>::infinity();
    NodeIndex node = kNoNode;
  };

  struct Counts {
    std::int64_t bounds = 0;
    std::int64_t transitions = 0;
  };

  // The least (value + TC) + penalty over the candidates, for a join with `node`, ties to the
  // smallest candidate; nothing above `limit` is found. Thread-safe.
  Best best_join(NodeIndex node, double penalty, double limit, Counts& counts) const;

  // A lower bound of the least value + TC for a join with `node`, infinity if it is above `limit`.
  double bound_join(NodeIndex node, double limit, Counts& counts) const;

  double least_value() const { return candidates_.empty() ? kInfinity : candidates_[0].value; }

private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kBlock = 32;

  struct Candidate {
    double value = 0.0;
    NodeIndex node = kNoNode;
  };

  // Lower bound of TC for candidate `c` given the bound of its gaps.
  double bounded_transition(const Candidate& c, NodeIndex node, float gaps) const;
  double transition(NodeIndex candidate, NodeIndex node) const;
  NodeIndex captured_partner(NodeIndex node) const;
  const MotionNode& info(NodeIndex node) const {
    return cost_.table().nodes[static_cast<std::size_t>(node)];
  }

  Side side_;
  const JoinCost& cost_;
  const JoinBound& bound_;
  std::vector<Candidate> candidates_; // by (value, node)
  std::vector<float> ends_;           // in the order of candidates_
  std::vector<std::int32_t> place_;   // per node of the table: into candidates_, or -1
};

// Calls work(i, counts) for i in [0, size) over threads and adds up the counts. `work` writes only
// what belongs to its i, so that the result does not depend on the number of threads; it must not
// throw.
template <typename Work>
void for_each_in_parallel(std::size_t size, JoinFrontier::Counts& counts, const Work& work) {
  constexpr std::size_t kWorthThreads = 48;
  std::int64_t bounds = 0;
  std::int64_t transitions = 0;
#pragma omp parallel for schedule(dynamic, 16) reduction(+ : bounds, transitions)                  \
    if (size > kWorthThreads)
  for (std::size_t i = 0; i < size; ++i) {
    JoinFrontier::Counts own;
    work(i, own);
    bounds += own.bounds;
    transitions += own.transitions;
  }
  counts.bounds += bounds;
  counts.transitions += transitions;
}

} // namespace phonomime
