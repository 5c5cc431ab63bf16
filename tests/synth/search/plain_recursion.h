// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

#include <functional>
#include <span>
#include <vector>

namespace phonomime::test {

// The judge: Algorithm 1 of E as it is printed, with DESIGN 4's readings, in O(N^2 T) and in plain
// loops. It shares no code with the search; sums follow the order that DESIGN 4 and join_cost.h
// define, so that costs can be compared to the bit.
class PlainRecursion {
public:
  // `fit` of a node at a step, beyond the paper's cost; empty: none.
  using Fit = std::function<double(const SearchStep& step, NodeIndex node)>;
  PlainRecursion(const MotionTable& table, const CostWeights& weights, Fit fit = {});

  double transition(NodeIndex from, NodeIndex to) const;
  double penalty(const SearchStep& step, NodeIndex node) const;
  static bool allowed(const SearchStep& step, NodeIndex node);

  // phi of Algorithm 1: per step, per node; infinite where the node is blocked.
  struct Tables {
    std::vector<std::vector<double>> phi;
    std::vector<std::vector<NodeIndex>> chi;
  };
  Tables tables(std::span<const SearchStep> steps) const;
  NodePath solve(std::span<const SearchStep> steps) const;

private:
  std::vector<float> channels(std::int64_t frame) const;
  double weight(Eigen::Index channel) const;
  std::vector<float> velocity(std::int64_t from_frame, std::int64_t to_frame) const;
  double gap(const std::vector<float>& a, const std::vector<float>& b) const;
  double smoothing(NodeIndex from, NodeIndex target) const;

  const MotionTable& table_;
  CostWeights weights_;
  Fit fit_;
  std::vector<std::vector<float>> first_pose_, last_pose_, first_velocity_, last_velocity_;
};

} // namespace phonomime::test
