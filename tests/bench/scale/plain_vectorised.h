// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_cost.h"

#include <span>
#include <vector>

namespace phonomime::bench {

// Algorithm 1 of E in O(N^2 T), as fast as it goes without cutting anything: every TC computed
// once, in parallel and with vector instructions, and kept (8 N^2 bytes); the recursion too.
class PlainVectorised {
public:
  // Computes all TC.
  PlainVectorised(const MotionTable& table, const CostWeights& weights);

  // The path of least cost; ties as in the search. NodePath::steps stays empty.
  NodePath solve(std::span<const SearchStep> steps) const;

private:
  const double* into(std::size_t node) const { return transitions_.data() + node * stride_; }

  const MotionTable& table_;
  JoinCost cost_;
  std::size_t stride_;              // nodes, up to whole vectors
  std::vector<double> transitions_; // [to][from]
};

} // namespace phonomime::bench
