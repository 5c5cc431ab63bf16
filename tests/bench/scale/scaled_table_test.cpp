// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/scaled_table.h"

#include "synth/search/cost_weights.h"
#include "tests/synth/search/plain_recursion.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>
#include <limits>
#include <set>

#include <gtest/gtest.h>

namespace phonomime::bench {
namespace {

MotionTable source_table() {
  test::Draw draw(3);
  test::TableShape shape;
  shape.sentences = 60;
  shape.longest_sentence = 12;
  return test::random_table(shape, draw);
}

TEST(ScaledTable, HasExactlyTheNodesAskedFor) {
  const MotionTable source = source_table();
  for (const NodeIndex nodes : {1, 57, source.node_count(), source.node_count() + 1, 1111}) {
    const MotionTable table = scaled_table(source, nodes, 0.3);
    EXPECT_EQ(table.node_count(), nodes);
    std::int64_t next_frame = 0;
    for (const MotionNode& node : table.nodes) {
      EXPECT_EQ(node.first_frame, next_frame);
      EXPECT_GE(node.frame_count, 1);
      next_frame += node.frame_count;
    }
    EXPECT_EQ(table.coefficients.rows(), next_frame);
    EXPECT_TRUE(table.coefficients.allFinite());
  }
}

TEST(ScaledTable, LinksNeighboursOfOneSentenceBothWays) {
  const MotionTable source = source_table();
  const MotionTable table = scaled_table(source, 1111, 0.3);
  std::int64_t links = 0;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
    ASSERT_LT(static_cast<std::size_t>(info.sentence), table.sentences.size());
    if (info.successor != kNoNode) {
      ++links;
      ASSERT_EQ(info.successor, node + 1);
      ASSERT_LT(info.successor, table.node_count());
      const MotionNode& next = table.nodes[static_cast<std::size_t>(info.successor)];
      EXPECT_EQ(next.predecessor, node);
      EXPECT_EQ(next.sentence, info.sentence);
      EXPECT_EQ(next.order, info.order + 1);
    }
    if (info.predecessor != kNoNode) {
      ASSERT_GE(info.predecessor, 0);
      EXPECT_EQ(table.nodes[static_cast<std::size_t>(info.predecessor)].successor, node);
    }
  }
  EXPECT_GT(links, table.node_count() / 2);
}

TEST(ScaledTable, KeysAreUniqueAndTheSameArgumentsGiveTheSameTable) {
  const MotionTable source = source_table();
  const MotionTable table = scaled_table(source, 1111, 0.3);
  std::set<std::string> keys;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    keys.insert(table.key(node));
  }
  EXPECT_EQ(keys.size(), 1111U);
  EXPECT_EQ(scaled_table(source, 1111, 0.3).coefficients, table.coefficients);
  EXPECT_NE(scaled_table(source, 1111, 0.2).coefficients, table.coefficients);
}

TEST(ScaledTable, EveryEmotionIsInAPartOfTheSource) {
  const MotionTable source = source_table();
  const MotionTable table = scaled_table(source, source.node_count() / 3, 0.3);
  std::set<std::int32_t> emotions;
  for (const MotionNode& node : table.nodes) {
    emotions.insert(node.emotion);
  }
  EXPECT_EQ(emotions.size(), source.emotions.size());
}

// The median over every node with a predecessor, by the judge's costs without penalties.
double plain_median_cheapest_join(const MotionTable& table, CostWeights weights) {
  weights.pnt = 0.0;
  const test::PlainRecursion plain(table, weights);
  std::vector<double> cheapest;
  for (NodeIndex to = 0; to < table.node_count(); ++to) {
    const NodeIndex before = table.nodes[static_cast<std::size_t>(to)].predecessor;
    if (before == kNoNode) {
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    for (NodeIndex from = 0; from < table.node_count(); ++from) {
      if (from != before) {
        least = std::min(least, plain.transition(from, to));
      }
    }
    cheapest.push_back(least);
  }
  std::ranges::sort(cheapest);
  return cheapest[cheapest.size() / 2];
}

TEST(ScaledTable, KeepsTheMedianCheapestJoinOfTheSource) {
  const MotionTable source = source_table();
  const CostWeights weights = default_cost_weights(source);
  const ScaledTable scaled = scaled_like(source, 3 * source.node_count());
  EXPECT_NEAR(scaled.cheapest_join / scaled.source_cheapest_join, 1.0, 0.2);
  // The sampled medians are near those over all nodes.
  const double of_source = plain_median_cheapest_join(source, weights);
  const double of_scaled = plain_median_cheapest_join(scaled.table, weights);
  EXPECT_NEAR(scaled.source_cheapest_join / of_source, 1.0, 0.15);
  EXPECT_NEAR(scaled.cheapest_join / of_scaled, 1.0, 0.15);
  EXPECT_EQ(scaled.source_cheapest_join, median_cheapest_join(source, weights));
}

} // namespace
} // namespace phonomime::bench
