// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/search/random_tables.h"

#include "db/types/errors.h"
#include "synth/search/cost_weights.h"
#include "synth/search/join_cost.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::Draw;

TEST(CostWeights, a_file_read_back_is_the_same) {
  Draw draw(1);
  const CostWeights weights = test::random_weights(draw);
  const CostWeights read = parse_cost_weights(format_cost_weights(weights), "w.json", {});
  EXPECT_EQ(read.alpha1, weights.alpha1);
  EXPECT_EQ(read.alpha2, weights.alpha2);
  EXPECT_EQ(read.alpha3, weights.alpha3);
  EXPECT_EQ(read.alpha4, weights.alpha4);
  EXPECT_EQ(read.alpha5, weights.alpha5);
  EXPECT_EQ(read.alpha6, weights.alpha6);
  EXPECT_EQ(read.pnt, weights.pnt);
}

TEST(CostWeights, members_left_out_keep_their_defaults) {
  const CostWeights defaults{1, 2, 3, 0.4, 5, 6, 7};
  const CostWeights read = parse_cost_weights(R"({"alpha5": 9})", "w.json", defaults);
  EXPECT_EQ(read.alpha5, 9.0);
  EXPECT_EQ(read.alpha3, 3.0);
  EXPECT_EQ(read.pnt, 7.0);
}

TEST(CostWeights, bad_files_have_one_clear_error) {
  const auto message = [](const char* text) {
    try {
      parse_cost_weights(text, "w.json", {1, 2, 3, 0.4, 5, 6, 7});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message(R"({"alpha4": 1})").find("alpha4"), std::string::npos);
  EXPECT_NE(message(R"({"alpha5": -1})").find("alpha5"), std::string::npos);
  EXPECT_NE(message(R"({"alfa5": 1})").find("w.json"), std::string::npos);
  EXPECT_NE(message(R"({"pnt": "x"})").find("pnt"), std::string::npos);
  EXPECT_NE(message(R"({"pnt": 1e999})").find("w.json"), std::string::npos);
  EXPECT_NE(message("").find("w.json"), std::string::npos);
}

// DESIGN 4: sentence starts must not become the cheapest joins.
TEST(CostWeights, by_default_a_sentence_start_costs_an_ordinary_join) {
  Draw draw(3);
  test::TableShape shape;
  shape.sentences = 80;
  const MotionTable table = test::random_table(shape, draw);
  const CostWeights weights = default_cost_weights(table);
  JoinCost cost(table, weights);
  std::vector<NodeIndex> nodes;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    nodes.push_back(node);
  }
  cost.ensure(nodes);
  // The median over every pair of rule 2, of which the default takes a sample.
  std::vector<double> joins;
  for (const NodeIndex to : nodes) {
    const NodeIndex before = table.nodes[static_cast<std::size_t>(to)].predecessor;
    for (const NodeIndex from : nodes) {
      if (before != kNoNode && before != from &&
          table.nodes[static_cast<std::size_t>(before)].viseme ==
              table.nodes[static_cast<std::size_t>(from)].viseme) {
        joins.push_back(cost.ordinary_join(from, to));
      }
    }
  }
  std::ranges::nth_element(joins, joins.begin() + static_cast<std::ptrdiff_t>(joins.size() / 2));
  EXPECT_NEAR(weights.alpha1 * weights.pnt, joins[joins.size() / 2], 0.2 * joins[joins.size() / 2]);
}

} // namespace
} // namespace phonomime
