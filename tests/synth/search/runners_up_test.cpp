// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/search/plain_recursion.h"
#include "tests/synth/search/random_tables.h"

#include "synth/search/viterbi_search.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::Draw;

// Against a search per candidate: the judge's best path with the node forced.
TEST(RunnersUp, are_the_best_paths_forced_through_other_nodes) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 1 + draw.below(6);
    shape.duplicate_chance = seed % 4 == 0 ? 0.5 : 0.0;
    const MotionTable table = test::random_table(shape, draw);
    const CostWeights weights = test::random_weights(draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 1 + draw.below(6), draw);
    const test::PlainRecursion judge(table, weights);
    ViterbiSearch search(table, weights);
    const SearchResult result = search.solve(steps, {.runners_up = 4});
    ASSERT_EQ(result.runners_up.size(), steps.size());
    for (std::size_t t = 0; t < steps.size(); ++t) {
      std::vector<double> deltas;
      for (NodeIndex node = 0; node < table.node_count(); ++node) {
        if (node == result.path.nodes[t] || !test::PlainRecursion::allowed(steps[t], node)) {
          continue;
        }
        std::vector<SearchStep> forced = steps;
        forced[t].allowed = {node};
        deltas.push_back(judge.solve(forced).cost - result.path.cost);
      }
      std::ranges::sort(deltas);
      const std::size_t wanted = std::min<std::size_t>(4, deltas.size());
      ASSERT_EQ(result.runners_up[t].size(), wanted);
      for (std::size_t i = 0; i < wanted; ++i) {
        const RunnerUp& other = result.runners_up[t][i];
        const double tolerance = 1e-9 * (1.0 + result.path.cost);
        EXPECT_NEAR(other.delta, deltas[i], tolerance) << "step " << t << ", place " << i;
        std::vector<SearchStep> forced = steps;
        forced[t].allowed = {other.node};
        EXPECT_NEAR(other.delta, judge.solve(forced).cost - result.path.cost, tolerance);
      }
    }
  }
}

} // namespace
} // namespace phonomime
