// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/exact_search.h"
#include "synth/search/relaxed_bounds.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::Draw;

TEST(RelaxedRecursion, has_looser_bounds_only_beyond_the_window) {
  int looser = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 100;
    shape.phonemes = 1;
    shape.visemes = 1;
    shape.emotions = 1 + draw.below(2);
    const MotionTable table = test::random_table(shape, draw);
    SearchSpace space(table, test::random_weights(draw));
    const std::vector<SearchStep> steps = test::random_steps(table, 3, draw, 0.0, 0.0);
    const std::vector<StepPenalties> penalties = space.penalties(steps);
    const RelaxedRecursion recursion(space.kernels, draw.chance(0.5) ? JoinFrontier::Side::later
                                                                     : JoinFrontier::Side::earlier);
    JoinFrontier::Counts counts;
    const NeighbourStep last = recursion.neighbour(recursion.border(penalties[2]), penalties[2]);
    const NeighbourStep neighbour =
        recursion.neighbour(recursion.next(penalties[1], last, counts), penalties[1]);
    const StepBounds all = recursion.next(penalties[0], neighbour, counts);
    std::vector<double> values;
    for (std::size_t i = 0; i < all.active.size(); ++i) {
      values.push_back(penalties[0][all.active[i]] + all.bound[i]);
    }
    const auto [least, largest] = std::ranges::minmax(values);
    const double window = draw.unit() * (largest - least);
    StepBounds within = recursion.border(penalties[0]);
    recursion.bound(within, penalties[0], neighbour, counts, window);
    ASSERT_EQ(within.active, all.active);
    EXPECT_EQ(within.inactive_bound, all.inactive_bound);
    for (std::size_t i = 0; i < all.active.size(); ++i) {
      ASSERT_LE(within.bound[i], all.bound[i]);
      if (values[i] <= least + window * (1.0 - 1e-9)) {
        ASSERT_EQ(within.bound[i], all.bound[i]) << i;
      } else {
        ASSERT_GE(penalties[0][all.active[i]] + within.bound[i], (least + window) * (1.0 - 1e-9))
            << i;
        looser += within.bound[i] < all.bound[i] ? 1 : 0;
      }
    }
  }
  EXPECT_GT(looser, 100);
}

} // namespace
} // namespace phonomime
