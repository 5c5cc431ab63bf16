// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/end_tree.h"
#include "synth/search/join_frontier.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::all_nodes;
using test::Draw;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

MotionTable drawn_table(std::uint64_t seed, Draw& draw) {
  test::TableShape shape;
  shape.groups = 1 + draw.below(40);
  shape.dimensions = 1 + draw.below(std::min(12, shape.groups));
  shape.kind = seed % 3 == 0 ? LayoutKind::weights : LayoutKind::markers;
  shape.duplicate_chance = 0.3;
  shape.sentences = 1 + draw.below(16);
  return test::random_table(shape, draw);
}

float city_block(const float* a, const float* b) {
  float sum = 0.0f;
  for (std::size_t f = 0; f < JoinSketch::kFeatures; ++f) {
    sum += std::abs(a[f] - b[f]);
  }
  return sum;
}

TEST(JoinBounds, are_never_above_the_gaps_they_bound) {
  double tightest_sketch = 0.0;
  double tightest_clusters = 0.0;
  double loosest_floor = 1.0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Draw draw(seed);
    const MotionTable table = drawn_table(seed, draw);
    const CostWeights weights = test::random_weights(draw);
    JoinKernels kernels(table, weights);
    kernels.ensure(all_nodes(table));
    for (NodeIndex i = 0; i < table.node_count(); ++i) {
      for (NodeIndex j = 0; j < table.node_count(); ++j) {
        const double exact =
            weights.alpha3 * kernels.cost.position_gap(i, j) + kernels.cost.velocity_gap(i, j);
        const auto distance = static_cast<double>(city_block(
            kernels.sketch.end(NodeEnd::last, i), kernels.sketch.end(NodeEnd::first, j)));
        const double sketch = std::max(0.0, distance * (1.0 - 1e-5) - kernels.sketch.margin());
        const double clusters = kernels.bound.gaps(i, j, kInfinity);
        const double enough = clusters * 2.0 * draw.unit();
        const double hasty = kernels.bound.gaps(i, j, enough);
        ASSERT_TRUE(hasty == clusters || hasty > enough * (1.0 - 1e-6));
        ASSERT_LE(hasty, clusters);
        const double floor = kernels.cost.gaps_floor(i, j);
        for (const double bound : {sketch, clusters, floor}) {
          ASSERT_GE(bound, 0.0);
          ASSERT_LE(bound, exact) << seed << ": " << i << "," << j;
        }
        if (exact > 1.0) {
          tightest_sketch = std::max(tightest_sketch, sketch / exact);
          tightest_clusters = std::max(tightest_clusters, clusters / exact);
          loosest_floor = std::min(loosest_floor, floor / exact);
        }
      }
    }
  }
  // Bounds of zero would be admissible, and useless.
  EXPECT_GT(tightest_sketch, 0.7);
  EXPECT_GT(tightest_clusters, 0.9);
  EXPECT_GT(loosest_floor, 0.9999);
}

TEST(JoinBounds, smoothing_in_single_precision_is_never_above_the_exact_one) {
  double loosest = 1.0;
  int cut_short = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Draw draw(seed);
    const MotionTable table = drawn_table(seed, draw);
    const CostWeights weights = test::random_weights(draw);
    const JoinCost cost(table, weights);
    for (NodeIndex to = 0; to < table.node_count(); ++to) {
      if (table.nodes[static_cast<std::size_t>(to)].predecessor == kNoNode) {
        continue;
      }
      for (NodeIndex from = 0; from < table.node_count(); ++from) {
        const double exact = cost.smoothing(from, to);
        const double floor = cost.smoothing_floor(kInfinity, from, to);
        ASSERT_GE(floor, 0.0);
        ASSERT_LE(floor, exact) << seed << ": " << from << "," << to;
        if (exact > 100.0) {
          loosest = std::min(loosest, floor / exact);
        }
        const double limit = 2.0 * exact * draw.unit();
        const double hasty = cost.smoothing_floor(limit, from, to);
        ASSERT_LE(hasty, floor);
        ASSERT_TRUE(hasty == floor || hasty > limit * (1.0 - 1e-4));
        cut_short += hasty < floor ? 1 : 0;
      }
    }
  }
  EXPECT_GT(loosest, 0.999);
  EXPECT_GT(cut_short, 100);
}

TEST(EndTree, shows_every_entry_that_may_be_within_the_limit) {
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Draw draw(seed);
    const MotionTable table = drawn_table(seed, draw);
    const CostWeights weights = test::random_weights(draw);
    JoinKernels kernels(table, weights);
    kernels.ensure(all_nodes(table));
    const NodeEnd which = draw.chance(0.5) ? NodeEnd::first : NodeEnd::last;
    const NodeEnd other = which == NodeEnd::first ? NodeEnd::last : NodeEnd::first;
    std::vector<NodeIndex> entries;
    for (const NodeIndex node : kernels.sketch.order(which)) {
      if (draw.chance(0.8)) {
        entries.push_back(node);
      }
    }
    EndTree tree(kernels.sketch, table, which, entries);
    std::vector<double> values;
    for (int time = 0; time < 2; ++time) { // other values replace the first
      values.clear();
      for (std::size_t i = 0; i < entries.size(); ++i) {
        values.push_back(draw.chance(0.1) ? kInfinity : 1000.0 * draw.unit());
      }
      tree.set_values(values);
    }
    for (NodeIndex node = 0; node < table.node_count(); ++node) {
      const std::int32_t viseme = join_viseme(table, other, node);
      const double limit = 3000.0 * draw.unit();
      std::vector<int> shown(entries.size(), 0);
      std::vector<double> bounds(entries.size(), 0.0);
      tree.search(
          kernels.sketch.end(other, node), viseme, weights.pnt, [&] { return limit; },
          [&](std::size_t place, std::int32_t entry_viseme, double bound) {
            ++shown[place];
            EXPECT_EQ(entry_viseme, join_viseme(table, which, entries[place]));
            EXPECT_LE(bound, limit);
            bounds[place] = bound;
          });
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const NodeIndex from = which == NodeEnd::last ? entries[i] : node;
        const NodeIndex to = which == NodeEnd::last ? node : entries[i];
        const double penalty = join_viseme(table, which, entries[i]) == viseme ? 0.0 : weights.pnt;
        const double exact = values[i] + (kernels.cost.gaps(from, to) + penalty);
        ASSERT_LE(bounds[i], exact);
        ASSERT_LE(shown[i], 1);
        ASSERT_TRUE(shown[i] == 1 || exact > limit) << node << " and entry " << i;
      }
    }
  }
}

TEST(EndTree, an_empty_one_shows_nothing) {
  const EndTree tree;
  std::vector<float> end(JoinSketch::kFeatures, 0.0f);
  tree.search(
      end.data(), 0, 1.0, [] { return kInfinity; },
      [](std::size_t, std::int32_t, double) { FAIL() << "there is no entry"; });
}

TEST(EndTree, looks_at_few_boxes_where_the_limit_is_small) {
  Draw draw(5);
  test::TableShape shape;
  shape.sentences = 600;
  shape.longest_sentence = 20;
  shape.groups = 20;
  shape.dimensions = 6;
  const MotionTable table = test::random_table(shape, draw);
  const JoinKernels kernels(table, {1.0, 0.2, 20.0, 0.4, 10.0, 10.0, 500.0});
  const std::vector<NodeIndex>& entries = kernels.sketch.order(NodeEnd::last);
  EndTree tree(kernels.sketch, table, NodeEnd::last, entries);
  tree.set_values(std::vector<double>(entries.size(), 0.0));
  double best = std::numeric_limits<double>::infinity();
  const float* end = kernels.sketch.end(NodeEnd::first, 100);
  const std::int64_t looked_at = tree.search(
      end, join_viseme(table, NodeEnd::first, 100), 500.0, [&] { return best; },
      [&](std::size_t place, std::int32_t, double) {
        best = std::min(best, static_cast<double>(city_block(
                                  end, kernels.sketch.end(NodeEnd::last, entries[place]))));
      });
  EXPECT_LT(looked_at, static_cast<std::int64_t>(entries.size()) / 2);
}

TEST(JoinSketch, puts_every_node_into_its_order_once) {
  Draw draw(3);
  const MotionTable table = drawn_table(3, draw);
  const JoinKernels kernels(table, test::random_weights(draw));
  const JoinSketch& sketch = kernels.sketch;
  for (const NodeEnd which : {NodeEnd::first, NodeEnd::last}) {
    std::vector<NodeIndex> order = sketch.order(which);
    for (std::size_t i = 0; i < order.size(); ++i) {
      EXPECT_EQ(sketch.rank(which)[static_cast<std::size_t>(order[i])],
                static_cast<std::int32_t>(i));
    }
    std::ranges::sort(order);
    EXPECT_EQ(order, all_nodes(table));
  }
}

} // namespace
} // namespace phonomime
