// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/viterbi_search.h"

#include <span>
#include <vector>

namespace phonomime {

// Searches of one transcript over and over while somebody edits its constraints, bans and emotions:
// each answer is exactly that of ViterbiSearch::solve, most of them far sooner.
//
// Keeps the relaxed bounds of both sides for every step of the transcript without its constraints.
// A constraint can only raise a cost, so that they go on to bound; and those of one side of a step
// do not depend on the step itself, so that they outlive a change of its emotion. The last edited
// step is the pivot: bounds of what follows it hold as they are, and before it only states are
// looked at again that the bounds of both sides leave within an upper bound, mostly a few dozen.
class SearchSession {
public:
  // `search` gives the table, the weights and what is known of nodes, and must outlive the session.
  explicit SearchSession(ViterbiSearch& search) : space_(search.space()) {}

  // As ViterbiSearch::solve. The first call, and one with another number of steps, takes about
  // twice as long.
  SearchResult solve(std::span<const SearchStep> steps, const SearchOptions& options = {},
                     const Progress& progress = {});

private:
  void take_over(std::span<const SearchStep> steps);
  void extend(std::size_t pivot, std::span<const StepPenalties> penalties, const Progress& progress,
              JoinFrontier::Counts& counts);

  SearchSpace& space_;
  std::vector<SearchStep> free_steps_; // of the last call, without their constraints
  std::vector<StepBounds> so_far_;     // per free step: bounds of all before it
  std::vector<StepBounds> to_go_;      // per free step: bounds of all after it
  std::size_t so_far_valid_ = 0;       // so_far_[0 .. so_far_valid_) hold
  std::size_t to_go_valid_ = 0;        // to_go_[to_go_valid_ .. end) hold
};

} // namespace phonomime
