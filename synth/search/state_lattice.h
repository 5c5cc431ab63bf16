// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/search/join_frontier.h"
#include "synth/search/relaxed_bounds.h"
#include "synth/search/step_costs.h"

#include <span>
#include <vector>

namespace phonomime {

// The states of one step that a pass has kept, with phi and chi of Algorithm 1.
struct StepStates {
  std::vector<NodeIndex> nodes;       // ascending
  std::vector<double> cost;           // phi: least cost of a path that ends here
  std::vector<double> penalty;        // OC + EMP
  std::vector<NodeIndex> predecessor; // chi; kNoNode at the first step

  void append(NodeIndex node, double own_penalty, const JoinFrontier::Best& best);
  std::size_t place_of(NodeIndex node) const; // of one that is there
};
using Lattice = std::vector<StepStates>;

// What the passes of a search share.
struct LatticeInput {
  std::span<const SearchStep> steps;
  std::span<const StepPenalties> penalties; // per step
  std::span<const StepBounds> to_go;        // per step: bounds of all that follows
  JoinKernels& kernels;
  const Progress& progress;
};

// The forward pass over all states from which a path of cost <= budget may be: exact costs for
// every path up to the budget. Ends with a step without states where there is none.
Lattice exact_lattice(const LatticeInput& input, double budget, JoinFrontier::Counts& counts);

// The exact cost of a path, summed as E4 is: an upper bound of the optimum.
double cost_of_path(JoinKernels& kernels, std::span<const StepPenalties> penalties,
                    std::span<const NodeIndex> path, JoinFrontier::Counts& counts);

// The best path of a lattice: smallest cost, ties to the smallest last node. Steps' cost terms are
// filled in.
NodePath best_path(const LatticeInput& input, const Lattice& lattice);

} // namespace phonomime
