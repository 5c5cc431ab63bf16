// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/search/plain_recursion.h"
#include "tests/synth/search/random_tables.h"

#include "db/types/errors.h"
#include "synth/search/exact_search.h"
#include "synth/search/relaxed_bounds.h"
#include "synth/search/step_costs.h"
#include "synth/search/viterbi_search.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <set>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::Draw;
using test::PlainRecursion;

void expect_same_as_judge(const MotionTable& table, const CostWeights& weights,
                          const std::vector<SearchStep>& steps) {
  const NodePath judged = PlainRecursion(table, weights).solve(steps);
  ViterbiSearch search(table, weights);
  for (const int threads : {1, 2}) {
    const NodePath path = search.solve(steps, {.threads = threads}).path;
    ASSERT_EQ(path.cost, judged.cost);
    ASSERT_EQ(path.nodes, judged.nodes);
  }
}

// Cost terms, summed as E4 is defined here, give the path's cost.
void expect_terms_add_up(const NodePath& path) {
  double sum = 0.0;
  for (std::size_t t = 0; t < path.steps.size(); ++t) {
    const double penalty = path.steps[t].observation + path.steps[t].emotion;
    sum = t == 0 ? penalty : (sum + path.steps[t].transition) + penalty;
  }
  EXPECT_EQ(sum, path.cost);
}

TEST(ViterbiSearch, equals_the_plain_recursion_on_random_databases) {
  for (std::uint64_t seed = 0; seed < 2400; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 1 + draw.below(12);
    shape.groups = 1 + draw.below(7);
    shape.kind = draw.chance(0.25) ? LayoutKind::weights : LayoutKind::markers;
    shape.dimensions =
        1 + draw.below(shape.kind == LayoutKind::markers ? 3 * shape.groups : shape.groups);
    shape.emotions = 1 + draw.below(4);
    shape.phonemes = 1 + draw.below(8);
    shape.duplicate_chance = seed % 3 == 0 ? 0.5 : 0.0;
    const MotionTable table = test::random_table(shape, draw);
    const CostWeights weights = test::random_weights(draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 1 + draw.below(14), draw);
    ASSERT_NO_FATAL_FAILURE(expect_same_as_judge(table, weights, steps));
  }
}

// By the definition: the plain recursion, again and again, without the nodes of the paths so far
// where a step has others that are near enough.
std::vector<NodePath> judged_disjoint_paths(const MotionTable& table, const CostWeights& weights,
                                            const std::vector<SearchStep>& steps, int count) {
  std::set<NodeIndex> used;
  std::vector<NodePath> paths;
  for (int k = 0; k < count; ++k) {
    std::vector<SearchStep> rest = steps;
    for (SearchStep& step : rest) {
      double least = std::numeric_limits<double>::infinity();
      for (const NodeIndex node : test::all_nodes(table)) {
        if (is_allowed(step, node)) {
          least = std::min(
              least, step_penalty(step, table.nodes[static_cast<std::size_t>(node)], weights));
        }
      }
      const bool others = std::ranges::any_of(test::all_nodes(table), [&](NodeIndex node) {
        return is_allowed(step, node) && !used.contains(node) &&
               (!step.allowed.empty() ||
                step_penalty(step, table.nodes[static_cast<std::size_t>(node)], weights) <=
                    least + 2.0 * weights.pnt);
      });
      if (others) {
        std::set<NodeIndex> avoided(step.avoided.begin(), step.avoided.end());
        avoided.insert(used.begin(), used.end());
        step.avoided.assign(avoided.begin(), avoided.end());
      }
    }
    paths.push_back(PlainRecursion(table, weights).solve(rest));
    used.insert(paths.back().nodes.begin(), paths.back().nodes.end());
  }
  return paths;
}

void expect_disjoint_paths_as_judged(const MotionTable& table, const CostWeights& weights,
                                     const std::vector<SearchStep>& steps, int count) {
  const std::vector<NodePath> judged = judged_disjoint_paths(table, weights, steps, count);
  ViterbiSearch search(table, weights);
  for (const int threads : {1, 2}) {
    const DisjointPaths found = search.solve_disjoint(steps, count, {.threads = threads});
    ASSERT_EQ(found.others.size() + 1, judged.size());
    for (std::size_t k = 0; k < judged.size(); ++k) {
      const NodePath& path = k == 0 ? found.best.path : found.others[k - 1];
      ASSERT_EQ(path.cost, judged[k].cost) << k;
      ASSERT_EQ(path.nodes, judged[k].nodes) << k;
    }
  }
}

TEST(ViterbiSearch, finds_disjoint_paths_one_after_another) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 1 + draw.below(14);
    shape.groups = 1 + draw.below(5);
    shape.dimensions = 1 + draw.below(3 * shape.groups);
    shape.emotions = 1 + draw.below(3);
    shape.phonemes = 1 + draw.below(5);
    shape.duplicate_chance = seed % 5 == 0 ? 0.5 : 0.0;
    const MotionTable table = test::random_table(shape, draw);
    const CostWeights weights = test::random_weights(draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 1 + draw.below(8), draw);
    ASSERT_NO_FATAL_FAILURE(
        expect_disjoint_paths_as_judged(table, weights, steps, 1 + draw.below(6)));
  }
}

TEST(ViterbiSearch, finds_disjoint_paths_in_larger_databases) {
  // Enough nodes a step that most joins are kept from path to path.
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 40;
    shape.phonemes = 2;
    shape.visemes = 2;
    shape.emotions = 1 + draw.below(2);
    const MotionTable table = test::random_table(shape, draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 8, draw, 0.02, 0.2);
    ASSERT_NO_FATAL_FAILURE(
        expect_disjoint_paths_as_judged(table, test::random_weights(draw), steps, 8));
  }
}

TEST(ViterbiSearch, equals_the_plain_recursion_on_larger_databases) {
  // A hundred nodes and more a phoneme: trees of bounds have several levels.
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 80;
    shape.phonemes = 2;
    shape.visemes = 2;
    shape.emotions = 1 + draw.below(2);
    shape.duplicate_chance = seed % 3 == 0 ? 0.3 : 0.0;
    const MotionTable table = test::random_table(shape, draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 6, draw, 0.02, 0.2);
    ASSERT_NO_FATAL_FAILURE(expect_same_as_judge(table, test::random_weights(draw), steps));
  }
}

TEST(ViterbiSearch, breaks_ties_as_the_plain_recursion_does) {
  // Every sentence is there twice, so that each optimum is there at least twice.
  for (std::uint64_t seed = 10000; seed < 10800; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 10;
    shape.duplicate_chance = 0.9;
    const MotionTable table = test::random_table(shape, draw);
    CostWeights weights = test::random_weights(draw);
    if (seed % 4 == 0) {
      weights.alpha2 = weights.alpha3 = 0.0;
    }
    const std::vector<SearchStep> steps = test::random_steps(table, 8, draw, 0.05, 0.2);
    ASSERT_NO_FATAL_FAILURE(expect_same_as_judge(table, weights, steps));
  }
}

TEST(ViterbiSearch, takes_costs_of_zero) {
  Draw draw(7);
  const MotionTable table = test::random_table({}, draw);
  CostWeights weights;
  weights.alpha4 = 0.5;
  expect_same_as_judge(table, weights, test::random_steps(table, 6, draw));
}

TEST(ViterbiSearch, terms_of_a_path_add_up_to_its_cost) {
  Draw draw(11);
  test::TableShape shape;
  shape.sentences = 20;
  const MotionTable table = test::random_table(shape, draw);
  for (int i = 0; i < 50; ++i) {
    ViterbiSearch search(table, test::random_weights(draw));
    expect_terms_add_up(search.solve(test::random_steps(table, 10, draw)).path);
  }
}

TEST(ViterbiSearch, returns_a_recorded_sentence_for_its_own_transcript) {
  Draw draw(13);
  test::TableShape shape;
  shape.sentences = 12;
  shape.longest_sentence = 9;
  shape.phonemes = 30;
  const MotionTable table = test::random_table(shape, draw);
  CostWeights weights{1.0, 0.2, 20.0, 0.4, 10.0, 10.0, 500.0};
  ViterbiSearch search(table, weights);
  for (NodeIndex start = 0; start < table.node_count(); ++start) {
    if (table.nodes[static_cast<std::size_t>(start)].predecessor != kNoNode) {
      continue;
    }
    std::vector<SearchStep> steps;
    std::vector<NodeIndex> own;
    for (NodeIndex node = start; node != kNoNode;
         node = table.nodes[static_cast<std::size_t>(node)].successor) {
      const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
      steps.push_back({.phoneme = info.phoneme, .viseme = info.viseme, .emotion = info.emotion});
      own.push_back(node);
    }
    const SearchResult result = search.solve(steps);
    EXPECT_EQ(result.path.cost, 0.0);
    if (own.size() >= 4) { // shorter ones may occur within others
      EXPECT_EQ(result.path.nodes, own);
    }
  }
}

TEST(ViterbiSearch, an_empty_transcript_has_an_empty_path) {
  Draw draw(17);
  const MotionTable table = test::random_table({}, draw);
  ViterbiSearch search(table, test::random_weights(draw));
  const SearchResult result = search.solve({});
  EXPECT_TRUE(result.path.nodes.empty());
  EXPECT_EQ(result.path.cost, 0.0);
}

TEST(ViterbiSearch, looks_at_the_same_things_with_every_number_of_threads) {
  Draw draw(19);
  test::TableShape shape;
  shape.sentences = 60;
  const MotionTable table = test::random_table(shape, draw);
  const CostWeights weights{1.0, 0.2, 20.0, 0.4, 1.0, 1.0, 50.0};
  const std::vector<SearchStep> steps = test::random_steps(table, 20, draw);
  const SearchResult one = ViterbiSearch(table, weights).solve(steps, {.threads = 1});
  const SearchResult four = ViterbiSearch(table, weights).solve(steps, {.threads = 4});
  EXPECT_EQ(one.counts.transitions, four.counts.transitions);
  EXPECT_EQ(one.counts.bounds, four.counts.bounds);
  EXPECT_EQ(one.counts.states, four.counts.states);
  EXPECT_EQ(one.path.nodes, four.path.nodes);
}

TEST(ViterbiSearch, passes_over_states_find_the_optimum_up_to_their_bound_and_nothing_above) {
  int missed = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    const MotionTable table = test::random_table({}, draw);
    const CostWeights weights = test::random_weights(draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 1 + draw.below(8), draw);
    const NodePath judged = PlainRecursion(table, weights).solve(steps);
    SearchSpace space(table, weights);
    const std::vector<StepPenalties> penalties = space.penalties(steps);
    const RelaxedRecursion recursion(space.kernels, JoinFrontier::Side::later);
    JoinFrontier::Counts counts;
    std::vector<StepBounds> to_go(steps.size());
    for (std::size_t t = steps.size(); t-- > 0;) {
      to_go[t] = t + 1 == steps.size()
                     ? recursion.border(penalties[t])
                     : recursion.next(penalties[t],
                                      recursion.neighbour(to_go[t + 1], penalties[t + 1]), counts);
    }
    const auto found = [&](double upper_bound) {
      return exact_search(space, steps, penalties, upper_bound, [&](double) { return to_go; }, {},
                          {}, {})
          .path;
    };
    EXPECT_EQ(found(judged.cost).nodes, judged.nodes);
    for (const double share : {0.5, 1.0 - 1e-6, 1.0 - 1e-12}) {
      if (judged.cost * share < judged.cost) {
        EXPECT_TRUE(found(judged.cost * share).nodes.empty()) << share;
        ++missed;
      }
    }
  }
  EXPECT_GT(missed, 60);
}

TEST(StepPenalties, of_several_nodes_are_those_of_each) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Draw draw(seed);
    const MotionTable table = test::random_table({}, draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 8, draw, 0.3, 0.5);
    SearchSpace space(table, test::random_weights(draw));
    const std::vector<NodeIndex> nodes = test::all_nodes(table);
    for (const StepPenalties& penalties : space.penalties(steps)) {
      const std::vector<double> several = penalties.of(nodes);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        ASSERT_EQ(several[i], penalties[nodes[i]]) << "seed " << seed;
      }
    }
  }
}

TEST(ViterbiSearch, stops_when_asked) {
  Draw draw(23);
  const MotionTable table = test::random_table({}, draw);
  ViterbiSearch search(table, test::random_weights(draw));
  const std::atomic<bool> stop = true;
  Progress progress;
  progress.stop = &stop;
  EXPECT_THROW(search.solve(test::random_steps(table, 5, draw), {}, progress), Interrupted);
}

TEST(ViterbiSearch, refuses_weights_out_of_range_and_an_empty_database) {
  Draw draw(29);
  const MotionTable table = test::random_table({}, draw);
  CostWeights weights = test::random_weights(draw);
  weights.alpha4 = 1.0;
  EXPECT_THROW(ViterbiSearch(table, weights), InputError);
  weights.alpha4 = 0.5;
  weights.alpha3 = -1.0;
  EXPECT_THROW(ViterbiSearch(table, weights), InputError);
  MotionTable empty = table;
  empty.nodes.clear();
  EXPECT_THROW(ViterbiSearch(empty, test::random_weights(draw)), InputError);
}

} // namespace
} // namespace phonomime
