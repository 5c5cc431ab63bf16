// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/streaming_search.h"
#include "tests/synth/search/plain_recursion.h"
#include "tests/synth/search/random_tables.h"

#include "db/types/errors.h"

#include <algorithm>
#include <span>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::Draw;
using test::PlainRecursion;

MotionTable drawn_table(std::uint64_t seed, Draw& draw) {
  test::TableShape shape;
  shape.sentences = 2 + draw.below(14);
  shape.emotions = 1 + draw.below(3);
  shape.duplicate_chance = seed % 3 == 0 ? 0.5 : 0.0;
  return test::random_table(shape, draw);
}

// E4 of a path, summed as the search defines it.
double cost_of(const PlainRecursion& plain, std::span<const SearchStep> steps,
               std::span<const NodeIndex> nodes) {
  double cost = plain.penalty(steps[0], nodes[0]);
  for (std::size_t t = 1; t < nodes.size(); ++t) {
    cost = (cost + plain.transition(nodes[t - 1], nodes[t])) + plain.penalty(steps[t], nodes[t]);
  }
  return cost;
}

TEST(StreamingSearch, says_what_its_path_costs_and_bounds_what_it_loses) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    const MotionTable table = drawn_table(seed, draw);
    const CostWeights weights = test::random_weights(draw);
    const std::vector<SearchStep> steps = test::random_steps(table, 1 + draw.below(14), draw);
    const auto look_ahead = static_cast<std::size_t>(draw.below(5));
    const PlainRecursion plain(table, weights);
    ViterbiSearch search(table, weights);
    StreamingSearch stream(search, static_cast<int>(look_ahead));
    std::vector<NodeIndex> nodes;
    for (std::size_t t = 0; t < steps.size(); ++t) {
      for (const NodeIndex node : stream.push(steps[t])) {
        nodes.push_back(node);
      }
      EXPECT_EQ(nodes.size(), t + 1 > look_ahead ? t + 1 - look_ahead : 0);
      const double optimum = plain.solve(std::span(steps).first(t + 1)).cost;
      EXPECT_GE(stream.cost(), optimum);
      EXPECT_LE(stream.lower_bound(), optimum * (1.0 + 1e-9) + 1e-9);
    }
    for (const NodeIndex node : stream.finish()) {
      nodes.push_back(node);
    }
    ASSERT_EQ(nodes.size(), steps.size());
    EXPECT_EQ(stream.cost(), cost_of(plain, steps, nodes));
    EXPECT_TRUE(stream.finish().empty());
    for (std::size_t t = 0; t < steps.size(); ++t) {
      EXPECT_TRUE(PlainRecursion::allowed(steps[t], nodes[t])) << "step " << t;
    }
  }
}

TEST(StreamingSearch, finds_the_optimum_with_the_whole_transcript_in_sight) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    const MotionTable table = drawn_table(seed, draw); // fewer nodes than the stream keeps states
    CostWeights weights = test::random_weights(draw);
    weights.alpha5 = std::min(weights.alpha5, 1.0); // no node is out of the question
    weights.alpha6 = std::min(weights.alpha6, 1.0);
    const std::vector<SearchStep> steps = test::random_steps(table, 8, draw);
    if (table.node_count() > 256) {
      continue;
    }
    ViterbiSearch search(table, weights);
    StreamingSearch stream(search, 8);
    for (const SearchStep& step : steps) {
      EXPECT_TRUE(stream.push(step).empty());
    }
    EXPECT_EQ(stream.cost(), search.solve(steps).path.cost);
    EXPECT_EQ(stream.finish().size(), steps.size());
  }
}

TEST(StreamingSearch, goes_on_after_the_end_was_taken_for_the_end) {
  Draw draw(5);
  const MotionTable table = drawn_table(5, draw);
  const CostWeights weights{1.0, 0.2, 20.0, 0.4, 10.0, 10.0, 500.0};
  const PlainRecursion plain(table, weights);
  ViterbiSearch search(table, weights);
  StreamingSearch stream(search, 2);
  const std::vector<SearchStep> steps = test::random_steps(table, 6, draw);
  std::vector<NodeIndex> nodes;
  const auto take = [&](const std::vector<NodeIndex>& more) {
    nodes.insert(nodes.end(), more.begin(), more.end());
  };
  for (const SearchStep& step : steps) {
    take(stream.push(step));
    take(stream.finish());
  }
  ASSERT_EQ(nodes.size(), steps.size());
  EXPECT_EQ(stream.cost(), cost_of(plain, steps, nodes));
}

TEST(StreamingSearch, refuses_a_negative_look_ahead) {
  Draw draw(5);
  const MotionTable table = drawn_table(5, draw);
  ViterbiSearch search(table, test::random_weights(draw));
  EXPECT_THROW(StreamingSearch(search, -1), InputError);
}

} // namespace
} // namespace phonomime
