// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/search_session.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::Draw;

// A constraint, a ban, an emotion, another phoneme, or constraints taken back.
void edit(std::vector<SearchStep>& steps, const MotionTable& table, Draw& draw) {
  SearchStep& step = steps[static_cast<std::size_t>(draw.below(static_cast<int>(steps.size())))];
  const auto some_nodes = [&](int most) {
    std::vector<NodeIndex> nodes;
    for (int i = draw.below(most); i >= 0; --i) {
      nodes.push_back(draw.below(table.node_count()));
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  };
  switch (draw.below(5)) {
  case 0:
    step.allowed = some_nodes(3);
    step.avoided.clear();
    break;
  case 1:
    step.allowed.clear();
    step.avoided = some_nodes(std::min(6, table.node_count() / 2));
    break;
  case 2:
    step.emotion = draw.below(static_cast<int>(table.emotions.size()));
    break;
  case 3:
    step.phoneme = 1 + draw.below(static_cast<int>(table.phonemes.size()) - 1);
    break;
  default:
    step.allowed.clear();
    step.avoided.clear();
  }
}

void expect_same(const SearchResult& session, const SearchResult& full) {
  ASSERT_EQ(session.path.cost, full.path.cost);
  ASSERT_EQ(session.path.nodes, full.path.nodes);
  ASSERT_EQ(session.runners_up.size(), full.runners_up.size());
  for (std::size_t t = 0; t < full.runners_up.size(); ++t) {
    ASSERT_EQ(session.runners_up[t].size(), full.runners_up[t].size()) << "step " << t;
    for (std::size_t k = 0; k < full.runners_up[t].size(); ++k) {
      EXPECT_EQ(session.runners_up[t][k].node, full.runners_up[t][k].node);
      EXPECT_EQ(session.runners_up[t][k].delta, full.runners_up[t][k].delta);
    }
  }
}

TEST(SearchSession, answers_every_edit_as_a_full_search_does) {
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    Draw draw(seed);
    test::TableShape shape;
    shape.sentences = 2 + draw.below(14);
    shape.emotions = 1 + draw.below(4);
    shape.duplicate_chance = seed % 3 == 0 ? 0.5 : 0.0;
    const MotionTable table = test::random_table(shape, draw);
    const CostWeights weights = test::random_weights(draw);
    std::vector<SearchStep> steps = test::random_steps(table, 1 + draw.below(12), draw);
    ViterbiSearch search(table, weights);
    SearchSession session(search);
    for (int round = 0; round < 12; ++round) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", round " << round);
      const SearchOptions options{.threads = 1 + round % 2, .runners_up = round % 4 == 3 ? 2 : 0};
      ASSERT_NO_FATAL_FAILURE(expect_same(session.solve(steps, options),
                                          ViterbiSearch(table, weights).solve(steps, options)));
      if (draw.chance(0.1)) {
        steps = test::random_steps(table, 1 + draw.below(12), draw); // another transcript
      } else {
        edit(steps, table, draw);
      }
    }
  }
}

TEST(SearchSession, looks_at_much_less_after_an_edit) {
  Draw draw(1);
  test::TableShape shape;
  shape.sentences = 400;
  shape.longest_sentence = 12;
  shape.groups = 20;
  shape.dimensions = 6;
  const MotionTable table = test::random_table(shape, draw);
  const CostWeights weights{1.0, 0.2, 20.0, 0.4, 10.0, 10.0, 500.0};
  std::vector<SearchStep> steps = test::random_steps(table, 30, draw, 0.0, 0.05);
  ViterbiSearch search(table, weights);
  SearchSession session(search);
  const SearchResult first = session.solve(steps);
  for (const std::size_t t : {0, 7, 15, 29}) {
    std::vector<SearchStep> edited = steps;
    edited[t].avoided = {first.path.nodes[t]};
    const SearchResult full = search.solve(edited);
    const SearchResult quick = session.solve(edited);
    EXPECT_EQ(quick.path.nodes, full.path.nodes);
    EXPECT_LT(5 * quick.counts.bounds, full.counts.bounds) << "step " << t;
  }
}

} // namespace
} // namespace phonomime
