// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/search/kept_joins.h"
#include "synth/search/relaxed_bounds.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace phonomime {

// Bounds of all that follows each step, for one path after another (docs/search_bounds.md).
class BoundsToGo {
public:
  // `further`: whether renew() is to come.
  BoundsToGo(JoinKernels& kernels, const Progress& progress, bool further);

  void make(std::span<const StepPenalties> penalties, JoinFrontier::Counts& counts);

  // After nodes have been taken away, and none given back. `within`: RelaxedRecursion::renew().
  void renew(std::span<const StepPenalties> penalties, double within, JoinFrontier::Counts& counts);

  const std::vector<StepBounds>& steps() const { return bounds_; }

private:
  // A step, as the one before it sees it.
  struct Seen {
    std::optional<NeighbourStep> step; // between visits only where it is kept
    bool kept = false;
    std::vector<double> values; // of the active nodes, after a visit
  };
  void keep_where_there_is_room();
  void see(std::size_t t, const StepPenalties& penalties);
  void leave(std::size_t t);

  RelaxedRecursion recursion_;
  const Progress& progress_;
  bool further_;
  double pnt_;
  std::vector<StepBounds> bounds_;
  std::vector<Seen> seen_;
  std::vector<KeptJoins> kept_; // per step, where further_
};

} // namespace phonomime
