// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/search/plain_recursion.h"
#include "tests/synth/search/random_tables.h"

#include "synth/search/join_cost.h"

#include <cmath>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::all_nodes;
using test::Draw;

// Two nodes of one marker on the x axis, in millimetres, at 10 Hz: positions by hand.
MotionTable one_marker_table(const std::vector<std::vector<float>>& sentences_x) {
  MotionTable table;
  table.layout.groups.push_back({"m", {}});
  table.rate_hz = 10.0;
  table.phonemes = {{"pau", "pau", Visibility::intermediate}, {"a", "v", Visibility::intermediate}};
  table.visemes = {"pau", "v"};
  table.emotions = {"neutral"};
  table.pca.mean = Eigen::VectorXd::Zero(3);
  table.pca.basis = Eigen::MatrixXd::Identity(3, 1);
  table.pca.variance = Eigen::VectorXd::Ones(1);
  std::vector<float> frames;
  for (const std::vector<float>& xs : sentences_x) {
    MotionNode node;
    node.phoneme = node.viseme = 1;
    node.first_frame = static_cast<std::int64_t>(frames.size());
    node.frame_count = static_cast<std::int32_t>(xs.size());
    frames.insert(frames.end(), xs.begin(), xs.end());
    table.nodes.push_back(node);
  }
  table.coefficients =
      Eigen::Map<FrameMatrix>(frames.data(), static_cast<Eigen::Index>(frames.size()), 1);
  return table;
}

TEST(JoinCost, follows_table_one_by_hand) {
  // Node 1 is the predecessor of node 2.
  MotionTable table = one_marker_table({{0, 1, 3}, {0, 0, 4, 4}, {5, 7}});
  table.nodes[1].successor = 2;
  table.nodes[2].predecessor = 1;
  const CostWeights weights{
      .alpha1 = 3, .alpha2 = 2, .alpha3 = 4, .alpha4 = 0.5, .alpha5 = 1, .alpha6 = 1, .pnt = 100};
  JoinCost cost(table, weights);
  cost.ensure(all_nodes(table));
  EXPECT_EQ(cost.transition(1, 2), 0.0);   // rule 1
  EXPECT_EQ(cost.transition(2, 0), 300.0); // rule 4
  EXPECT_EQ(cost.position_gap(0, 2), 2.0); // 3 -> 5
  EXPECT_EQ(cost.velocity_gap(0, 2), 0.0); // (3-1) * 10 against (7-5) * 10
  // E6: w = node 0 resampled to four frames: 0, 2/3, 5/3, 3; s = 0, 1/3, 2/3, 1.
  const double b[] = {0.0, 2.0 / 3.0 * (2.0 / 3.0), 1.0 / 3.0 * (5.0 / 3.0) + 2.0 / 3.0 * 4.0, 4.0};
  const double expected =
      10.0 * (std::abs(b[0] - 2 * b[1] + b[2]) + std::abs(b[1] - 2 * b[2] + b[3]));
  EXPECT_NEAR(cost.direct_smoothing_cost(0, 1), expected, 1e-5);
  EXPECT_NEAR(cost.transition(0, 2), 2 * expected + 4 * 2.0, 1e-4); // rule 2
  table.nodes[0].viseme = 0;
  EXPECT_NEAR(cost.transition(0, 2), 2 * expected + 4 * 2.0 + 100.0, 1e-4); // rule 3
}

TEST(JoinCost, a_node_of_one_frame_has_no_velocity_and_short_targets_cost_no_smoothing) {
  MotionTable table = one_marker_table({{2}, {0, 9}, {5}});
  table.nodes[2].predecessor = 1;
  JoinCost cost(table, {.alpha2 = 1, .alpha3 = 1, .alpha4 = 0.5});
  cost.ensure(all_nodes(table));
  EXPECT_EQ(cost.velocity_gap(0, 2), 0.0);
  EXPECT_EQ(cost.direct_smoothing_cost(0, 1), 0.0);
  EXPECT_EQ(cost.transition(0, 2), 3.0);
}

TEST(JoinCost, equals_the_plain_formula_to_the_bit) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Draw draw(seed);
    test::TableShape shape;
    shape.groups = 1 + draw.below(20);
    shape.dimensions = 1 + draw.below(shape.groups);
    shape.kind = seed % 2 == 0 ? LayoutKind::markers : LayoutKind::weights;
    const MotionTable table = test::random_table(shape, draw);
    const CostWeights weights = test::random_weights(draw);
    const test::PlainRecursion plain(table, weights);
    JoinCost cost(table, weights);
    cost.ensure(all_nodes(table));
    for (NodeIndex i = 0; i < table.node_count(); ++i) {
      for (NodeIndex j = 0; j < table.node_count(); ++j) {
        ASSERT_EQ(cost.transition(i, j), plain.transition(i, j)) << seed << ": " << i << "," << j;
      }
    }
  }
}

} // namespace
} // namespace phonomime
