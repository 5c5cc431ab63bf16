// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/nearest_nodes.h"

#include "tests/tools/evaluate/small_table.h"

#include <gtest/gtest.h>

#include <limits>

namespace phonomime {
namespace {

// Row i of m is taken at i (n - 1) / (m - 1) of a node's n frames, the middle where m = 1.
Eigen::RowVectorXd warped_row(const FrameMatrix& node, int i, int m) {
  const double last = static_cast<double>(node.rows() - 1);
  const double u = m == 1 ? 0.5 * last : i * last / (m - 1);
  const auto before = static_cast<Eigen::Index>(u);
  const Eigen::Index after = std::min(before + 1, node.rows() - 1);
  const double share = u - static_cast<double>(before);
  return (1.0 - share) * node.row(before).cast<double>() + share * node.row(after).cast<double>();
}

NodeIndex plainly_nearest(const MotionTable& table, const FrameMatrixD& stretch) {
  NodeIndex best = kNoNode;
  double least = std::numeric_limits<double>::infinity();
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    const FrameMatrix frames = table.node_frames(node);
    double sum = 0.0;
    for (int i = 0; i < stretch.rows(); ++i) {
      sum +=
          (warped_row(frames, i, static_cast<int>(stretch.rows())) - stretch.row(i)).squaredNorm();
    }
    if (sum < least) {
      least = sum;
      best = node;
    }
  }
  return best;
}

TEST(NearestNodes, AreThoseOfAPlainSearch) {
  test::Draw draw(7);
  const MotionTable table = test::contextual_table(draw, 40);
  const NearestNodes nearest(table);
  for (int round = 0; round < 20; ++round) {
    std::vector<FrameMatrixD> stretches;
    for (int i = 0; i < 10; ++i) {
      stretches.emplace_back(1 + draw.below(12), table.coefficients.cols());
      for (double& value : stretches.back().reshaped()) {
        value = 3.0 * draw.symmetric();
      }
    }
    const std::vector<NodeIndex> found = nearest.find(stretches);
    ASSERT_EQ(found.size(), stretches.size());
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      EXPECT_EQ(found[i], plainly_nearest(table, stretches[i])) << round << " " << i;
    }
  }
}

TEST(NearestNodes, OfEqualOnesTheFirst) {
  test::Draw draw(3);
  MotionTable table = test::contextual_table(draw, 4);
  // Every sentence again, as later nodes with the same frames.
  const NodeIndex once = table.node_count();
  for (NodeIndex node = 0; node < once; ++node) {
    table.nodes.push_back(table.nodes[static_cast<std::size_t>(node)]);
  }
  std::vector<FrameMatrixD> stretches;
  for (NodeIndex node = 0; node < once; ++node) {
    stretches.emplace_back(table.node_frames(node).cast<double>());
  }
  const std::vector<NodeIndex> found = NearestNodes(table).find(stretches);
  for (NodeIndex node = 0; node < once; ++node) {
    EXPECT_EQ(found[static_cast<std::size_t>(node)],
              plainly_nearest(table, stretches[static_cast<std::size_t>(node)]));
    EXPECT_LT(found[static_cast<std::size_t>(node)], once);
  }
}

} // namespace
} // namespace phonomime
