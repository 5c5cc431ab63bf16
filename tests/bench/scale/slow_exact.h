// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_cost.h"

#include <span>

namespace phonomime::bench {

// A second exact search, for sizes at which no table of all joins fits: Algorithm 1 of E forward
// over all nodes. For each node the candidates in order of cost, until cost alone is above the best
// found; a join is skipped where the coefficients' difference alone makes it too dear (DESIGN 4).
// Shares only JoinCost with the search. NodePath::steps stays empty. Takes its time.
NodePath slow_exact(const MotionTable& table, const CostWeights& weights,
                    std::span<const SearchStep> steps);

} // namespace phonomime::bench
