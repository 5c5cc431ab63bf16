// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_frontier.h"
#include "synth/search/step_costs.h"

#include <span>
#include <vector>

namespace phonomime {

// Lower bounds, for every node of the table at one step, of the cost of everything on one side of
// it: all steps after it (side later), or all before (side earlier), with the join that leads
// there, without the node's own penalty.
struct StepBounds {
  std::vector<NodeIndex> active;  // ascending: nodes that were looked at one by one
  std::vector<double> bound;      // of each active one
  std::vector<NodeIndex> partner; // of each: whose join it is; kNoNode where none is known
  double active_penalty = 0.0;    // the most that an active node has; any other has more
  double inactive_bound = 0.0;    // of every other node

  double operator[](NodeIndex node) const;

  // Keeps the active nodes for which keep(node, bound) holds.
  template <typename Keep>
  void keep_if(const Keep& keep) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < active.size(); ++i) {
      if (keep(active[i], bound[i])) {
        active[kept] = active[i];
        bound[kept] = bound[i];
        partner[kept] = partner[i];
        ++kept;
      }
    }
    active.resize(kept);
    bound.resize(kept);
    partner.resize(kept);
  }
};

// One step of the relaxed recursion: Algorithm 1 with bounds in the place of joins.
//
// With v(y) = penalty + bound of node y at the neighbouring step, any node x has at least the bound
// min(v). The active nodes, those near the step's least penalty (StepPenalties::near), get better:
// the least bound over joins with the active ones of the neighbouring step, tight where they are
// few enough, or the least v of an inactive one where that is less.
class RelaxedRecursion {
public:
  RelaxedRecursion(JoinKernels& kernels, JoinFrontier::Side side)
      : kernels_(kernels), side_(side) {}

  // Bounds at the last step of the side.
  StepBounds border(const StepPenalties& penalties) const;

  // Bounds at a step, from those at its neighbour on the side.
  StepBounds next(const StepPenalties& penalties, const StepBounds& neighbour,
                  const StepPenalties& neighbour_penalties, JoinFrontier::Counts& counts) const;

  // Bounds of these nodes (ascending) alone, from those of the neighbouring step; infinite for one
  // whose bound is above its limit (as many as nodes).
  StepBounds bounds_of(std::vector<NodeIndex> nodes, std::span<const double> limits,
                       const StepBounds& neighbour, const StepPenalties& neighbour_penalties,
                       JoinFrontier::Counts& counts) const;

  // Whose join gave the bound of `node` in `own`, if that is known and not blocked; else the one of
  // the neighbour's active nodes with the least rough bound for a join with it.
  NodeIndex partner(NodeIndex node, const StepBounds& own, const StepBounds& neighbour,
                    const StepPenalties& neighbour_penalties, JoinFrontier::Counts& counts) const;

private:
  JoinFrontier frontier(const StepBounds& neighbour, const StepPenalties& penalties) const;

  JoinKernels& kernels_;
  JoinFrontier::Side side_;
};

} // namespace phonomime
