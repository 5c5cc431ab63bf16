// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/state_lattice.h"
#include "synth/search/viterbi_search.h"

#include <deque>
#include <vector>

namespace phonomime {

// The search over a transcript that is still growing: a node is final once `look_ahead` further
// steps are known. Not exact: what lies beyond the look-ahead is not known when a node is chosen.
//
// Algorithm 1 forwards over the most promising states of each step, whose costs are exact. When a
// step leaves the look-ahead, its node on the best path so far becomes final, and only paths
// through it go on. Work and memory per step do not grow with the transcript (but for the steps
// themselves, which lower_bound() asks for).
class StreamingSearch {
public:
  // `search` must outlive the stream. Throws InputError for a negative look_ahead (in steps).
  StreamingSearch(ViterbiSearch& search, int look_ahead, const SearchOptions& options = {});

  // Adds a step; returns the nodes that are final with it, in order (none or one). Throws
  // InternalError for a step at which no node is allowed.
  std::vector<NodeIndex> push(const SearchStep& step);

  // No further step comes: the rest becomes final.
  std::vector<NodeIndex> finish();

  // Of the steps so far: the cost of the path that the final nodes and the best continuation make,
  // to the bit that of E4, and a lower bound of the optimum: cost() - lower_bound() is the most
  // that can be lost. The bound costs a look at all matching pairs of nodes of the steps that have
  // come since it was last asked for.
  double cost() const;
  double lower_bound();

private:
  struct Column {
    const SearchStep* step = nullptr;
    StepStates states;
  };

  StepStates first_states(const SearchStep& step) const;
  StepStates next_states(const StepStates& before, const SearchStep& step) const;
  std::vector<NodeIndex> best_open_path() const;
  void make_final(NodeIndex node);
  std::size_t open_count() const { return columns_.size() - (front_is_final_ ? 1 : 0); }

  SearchSpace& space_;
  std::size_t look_ahead_;
  int threads_;
  std::deque<SearchStep> steps_; // all so far; elements stay where they are
  std::deque<Column> columns_;   // the last final step, where there is one, and the open ones
  bool front_is_final_ = false;
  std::size_t bounded_steps_ = 0; // that so_far_ has seen
  StepBounds so_far_;             // of the last of them
  double lower_bound_ = 0.0;
};

} // namespace phonomime
