// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"

#include "synth/search/state_lattice.h"
#include "synth/search/thread_count.h"

namespace phonomime {

SearchResult ViterbiSearch::solve(std::span<const SearchStep> steps, const SearchOptions& options,
                                  const Progress& progress) {
  if (steps.empty()) {
    return {};
  }
  const ThreadCount threads(options.threads);
  JoinFrontier::Counts counts;
  const std::vector<StepPenalties> penalties = space_.penalties(steps);
  const RelaxedRecursion recursion(space_.kernels, JoinFrontier::Side::later);
  std::vector<StepBounds> to_go(steps.size());
  to_go.back() = recursion.border(penalties.back());
  for (std::size_t t = steps.size() - 1; t-- > 0;) {
    progress.update("search", 0, static_cast<std::int64_t>(steps.size()));
    to_go[t] = recursion.next(penalties[t], to_go[t + 1], penalties[t + 1], counts);
  }
  const LatticeInput input{steps, penalties, to_go, space_.kernels, progress};
  const double upper_bound = cost_of_relaxed_path(input, counts);
  return exact_search(
      space_, steps, penalties, upper_bound, [&](double) { return to_go; }, options, progress,
      counts);
}

} // namespace phonomime
