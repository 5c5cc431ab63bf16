// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_frontier.h"
#include "synth/search/kept_joins.h"
#include "synth/search/step_costs.h"

#include <cstddef>
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

// What the nodes of a step see of the neighbouring one: v(y) = penalty + bound of its nodes y.
struct NeighbourStep {
  void see(const StepBounds& bounds, const StepPenalties& penalties);

  JoinFrontier frontier;       // the active nodes, by v; infinite until see() has been called
  double least = 0.0;          // of those
  double least_inactive = 0.0; // at most v of any other
};

// One step of the relaxed recursion: Algorithm 1 with bounds in the place of joins.
//
// Any node has at least the bound min(v) of its neighbours. The active nodes, those near the step's
// least penalty (StepPenalties::near), get better: the least bound over joins with the active ones
// of the neighbouring step, tight where they are few enough, or the least v of an inactive one
// where that is less.
class RelaxedRecursion {
public:
  // Where more than `many` nodes are active at a step, bounds of joins with them are rough: full
  // poses for all of them would cost more than they save.
  RelaxedRecursion(JoinKernels& kernels, JoinFrontier::Side side, std::size_t many = 4096)
      : kernels_(kernels), side_(side), many_(many) {}

  // Bounds at the last step of the side, and of any before its neighbour is known: 0.
  StepBounds border(const StepPenalties& penalties) const;

  NeighbourStep neighbour(const StepBounds& bounds, const StepPenalties& penalties) const;
  // For see() of those bounds. Thread-safe.
  NeighbourStep neighbour(const StepBounds& bounds) const;

  // Gives the nodes of a step their bounds. Those whose penalty + bound is more than `window` above
  // about the least of the step get one that holds and is not tight. `kept` is filled for renew()
  // where it is given.
  void bound(StepBounds& bounds, const StepPenalties& penalties, const NeighbourStep& neighbour,
             JoinFrontier::Counts& counts, double window = JoinFrontier::kInfinity,
             KeptJoins* kept = nullptr) const;

  // border() with those bounds.
  StepBounds next(const StepPenalties& penalties, const NeighbourStep& neighbour,
                  JoinFrontier::Counts& counts) const;

  // Has the bounds of the active nodes rise after the values of the neighbour's have: they were
  // `before`. Where the least join of a node may be none of those kept, they are looked for again
  // if its penalty + bound is at most `within` above the step's least; other bounds hold, but need
  // not be tight.
  void renew(StepBounds& bounds, KeptJoins& kept, const StepPenalties& penalties,
             const NeighbourStep& neighbour, std::span<const double> before, double within,
             JoinFrontier::Counts& counts) const;

  // Bounds of these nodes (ascending) alone; infinite for one whose bound is above its limit (as
  // many as nodes).
  StepBounds bounds_of(std::vector<NodeIndex> nodes, std::span<const double> limits,
                       const NeighbourStep& neighbour, JoinFrontier::Counts& counts) const;

  // Whose join gave the bound of `node` in `own`, if that is known and not blocked; else the one of
  // the neighbour's active nodes with the least rough bound for a join with it.
  NodeIndex partner(NodeIndex node, const StepBounds& own, const StepBounds& neighbour,
                    const StepPenalties& neighbour_penalties, JoinFrontier::Counts& counts) const;

private:
  // Which of the active nodes to look for joins of, by their places.
  struct Wanted {
    std::vector<std::size_t> places;
    // One of the two, of these; as JoinFrontier::BoundOptions has them.
    std::vector<double> limits;
    std::vector<JoinFrontier::LeastJoins> known;
  };
  void look(StepBounds& bounds, const Wanted& wanted, const NeighbourStep& neighbour,
            KeptJoins* kept, JoinFrontier::Counts& counts) const;
  // Of all nodes, sorted by ends.
  std::vector<std::size_t> all_places(std::span<const NodeIndex> nodes) const;
  // Has places whose nodes' ends are alike stand near each other.
  void sort_by_ends(std::vector<std::size_t>& places, std::span<const NodeIndex> nodes) const;

  JoinKernels& kernels_;
  JoinFrontier::Side side_;
  std::size_t many_;
};

} // namespace phonomime
