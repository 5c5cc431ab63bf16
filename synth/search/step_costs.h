// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/context_fit.h"
#include "synth/search/node_classes.h"
#include "synth/search/search_types.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace phonomime {

// OC of E Table II.
double observation_cost(const SearchStep& step, const MotionNode& node, const CostWeights& weights);

// EMP of E5.
double emotion_cost(const SearchStep& step, const MotionNode& node, const CostWeights& weights);

// OC + EMP of a node at a step: the paper's part of a step's penalty.
double step_penalty(const SearchStep& step, const MotionNode& node, const CostWeights& weights);

// B of E10: whether the node may stand at the step.
bool is_allowed(const SearchStep& step, NodeIndex node);

// (OC + EMP) + fit of the nodes of a table at one step, infinite where B blocks a node.
class StepPenalties {
public:
  // Keeps references to `classes`, `step` and `fit`. Not for parallel regions. Throws InternalError
  // where B blocks every node.
  StepPenalties(const MotionTable& table, const NodeClasses& classes, const SearchStep& step,
                const CostWeights& weights, ContextFit& fit);

  // The same under the constraints of `step`, which asks for the same otherwise; near() reaches so
  // much `further`.
  StepPenalties under(const SearchStep& step, double further = 0.0) const;

  double operator[](NodeIndex node) const;
  std::vector<double> of(std::span<const NodeIndex> nodes) const; // ascending
  FitCost fit_of(NodeIndex node) const;
  double least() const { return least_; } // of the nodes that are not blocked

  // The most that a node near the least has: 2 PNT above it, 3 where fits count. Nodes further off
  // are looked at only where bounds cannot exclude them.
  double near() const { return near_; }

  // The nodes of a penalty up to `most`, ascending; all that are allowed where the step names them.
  // Neither this nor least_beyond() is for parallel regions: they learn fits.
  std::vector<NodeIndex> nodes_up_to(double most) const;
  // At most the least penalty of any other node than nodes_up_to(most); infinite where none is
  // left.
  double least_beyond(double most) const;

  std::int64_t allowed_count() const;

private:
  // What does not depend on constraints.
  struct Free {
    std::vector<double> by_class;   // OC + EMP
    std::vector<std::size_t> order; // of the classes, cheapest first
    ContextFit::Wish wish;
    std::vector<std::vector<double>> fits; // per class its nodes', or empty: not learnt yet
  };
  static std::shared_ptr<Free> make_free(const MotionTable& table, const NodeClasses& classes,
                                         const SearchStep& step, const CostWeights& weights,
                                         ContextFit& fit);
  StepPenalties(const NodeClasses& classes, const SearchStep& step, ContextFit& fit,
                std::shared_ptr<Free> free, double pnt);
  void learn_fits(std::size_t class_index) const;
  // Of a node that is not blocked.
  double free_penalty(NodeIndex node) const;
  // Of one of a class, by its place there; fits are learnt already where they count.
  double free_penalty(std::size_t class_index, std::size_t place) const;

  const NodeClasses& classes_;
  const SearchStep& step_;
  ContextFit& fit_;
  std::shared_ptr<Free> free_;
  double pnt_;
  double least_;
  double near_;
};

} // namespace phonomime
