// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/state_lattice.h"

#include <vector>

namespace phonomime {

// Another node for one step, with what the best path through it costs more than the best path.
struct RunnerUp {
  NodeIndex node = kNoNode;
  double delta = 0.0;
};

// The `count` best other nodes of every step, exact, by one backward pass over a lattice that holds
// every state on a path up to `budget`. Returns nothing where some step has fewer than it could
// have within the budget: then a wider lattice is needed.
struct RunnersUp {
  bool complete = false;
  std::vector<std::vector<RunnerUp>> steps; // by (delta, node)
};
RunnersUp find_runners_up(const LatticeInput& input, const Lattice& lattice, const NodePath& path,
                          int count, double budget, JoinFrontier::Counts& counts);

} // namespace phonomime
