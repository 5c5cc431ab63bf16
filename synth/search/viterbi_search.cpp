// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/viterbi_search.h"

#include "synth/search/state_lattice.h"
#include "synth/search/thread_count.h"

#include <algorithm>

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
  // A real path: from the start of least bound along the joins that the bounds took.
  std::vector<NodeIndex> path = {*std::ranges::min_element(
      to_go[0].active, {}, [&](NodeIndex start) { return penalties[0][start] + to_go[0][start]; })};
  for (std::size_t t = 1; t < steps.size(); ++t) {
    path.push_back(recursion.partner(path.back(), to_go[t - 1], to_go[t], penalties[t], counts));
  }
  const double upper_bound = cost_of_path(space_.kernels, penalties, path, counts);
  return exact_search(
      space_, steps, penalties, upper_bound, [&](double) { return to_go; }, options, progress,
      counts);
}

} // namespace phonomime
