// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/concatenate.h"

#include "db/types/frame_times.h"
#include "synth/concat/resample.h"
#include "tests/synth/concat/plain_concatenate.h"
#include "tests/synth/concat/synthetic_table.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::random_table;
using test::steps_of;

int length_of(const MotionTable& table, NodeIndex node) {
  return table.nodes[static_cast<std::size_t>(node)].frame_count;
}

TEST(Concatenate, GivesASentenceBackBitForBit) {
  std::mt19937 random(11);
  for (int round = 0; round < 40; ++round) {
    const MotionTable table = random_table(random, 3, 8);
    std::vector<std::pair<NodeIndex, int>> parts = {{kNoNode, 31}};
    const NodeIndex first = 8 * (round % 3);
    for (NodeIndex node = first; node < first + 8; ++node) {
      parts.emplace_back(node, length_of(table, node));
    }
    parts.emplace_back(kNoNode, 17);
    const FrameMatrixD motion = concatenate(table, steps_of(table, parts)).coefficients;
    const auto& begin = table.nodes[static_cast<std::size_t>(first)];
    const auto& end = table.nodes[static_cast<std::size_t>(first) + 7];
    const Eigen::Index count = end.first_frame + end.frame_count - begin.first_frame;
    ASSERT_EQ(motion.rows(), 31 + count + 17 + 1);
    EXPECT_TRUE(motion.middleRows(31, count) ==
                table.coefficients.middleRows(begin.first_frame, count).cast<double>());
    EXPECT_TRUE(motion.row(0) == table.pca.project(table.reference_pose).transpose());
  }
}

// Random paths with pauses, shown pauses and captured runs, against the plain implementation.
TEST(Concatenate, DoesWhatThePlainImplementationDoes) {
  std::mt19937 random(12);
  for (int round = 0; round < 200; ++round) {
    const MotionTable table = random_table(random, 4, 6);
    std::uniform_int_distribution<NodeIndex> any(0, table.node_count() - 1);
    std::uniform_int_distribution<int> count(1, 25);
    std::uniform_int_distribution<int> dice(0, 9);
    std::vector<std::pair<NodeIndex, int>> parts;
    for (int i = 0; i < 12; ++i) {
      const NodeIndex before = parts.empty() ? kNoNode : parts.back().first;
      const NodeIndex after =
          before == kNoNode ? kNoNode : table.nodes[static_cast<std::size_t>(before)].successor;
      const int kind = dice(random);
      const NodeIndex node = kind < 2                       ? kNoNode
                             : kind < 5 && after != kNoNode ? after
                                                            : any(random);
      parts.emplace_back(node, dice(random) < 3 && node != kNoNode ? length_of(table, node)
                                                                   : count(random));
    }
    std::vector<ConcatStep> steps = steps_of(table, parts);
    for (ConcatStep& step : steps) {
      if (step.is_silence) {
        step.node = any(random); // what the search chose for /pau/ is not seen
        step.show_node = dice(random) == 0;
      }
    }
    ConcatOptions options;
    options.silence.fill = static_cast<SilenceFill>(round % 3);
    options.silence.rest_at_ends = round % 5 != 0;
    options.smoothing_half_window = round % 7 == 0 ? round % 6 : 3;
    const FrameMatrixD motion = concatenate(table, steps, options).coefficients;
    const FrameMatrixD expected = test::plain_concatenate(table, steps, options);
    ASSERT_EQ(motion.rows(), expected.rows());
    ASSERT_LT((motion - expected).cwiseAbs().maxCoeff(), 1e-10) << "round " << round;
  }
}

TEST(Concatenate, SmoothsOnlyJoinsThatWereNotCaptured) {
  std::mt19937 random(13);
  const MotionTable table = random_table(random, 2, 5, 1); // nodes of one frame
  MotionTable longer = table;
  longer.coefficients = FrameMatrix::Random(100, 3);
  for (NodeIndex i = 0; i < 10; ++i) {
    longer.nodes[static_cast<std::size_t>(i)].first_frame = 10 * i;
    longer.nodes[static_cast<std::size_t>(i)].frame_count = 10;
  }
  const auto steps = steps_of(longer, {{0, 10}, {1, 10}, {7, 10}, {8, 10}});
  const FrameMatrixD motion = concatenate(longer, steps).coefficients;
  const FrameMatrixD recorded = longer.coefficients.cast<double>();
  EXPECT_TRUE(motion.middleRows(0, 17) == recorded.middleRows(0, 17));
  EXPECT_TRUE(motion.middleRows(23, 17) == recorded.middleRows(73, 17));
  for (Eigen::Index k = 17; k < 23; ++k) { // three frames a side
    EXPECT_FALSE(motion.row(k) == recorded.row(k < 20 ? k : 50 + k)) << k;
  }
}

TEST(Concatenate, WeighsEachSideByItsNodesPhoneme) {
  std::mt19937 random(14);
  MotionTable table = random_table(random, 2, 1, 1, 1);
  table.coefficients.resize(20, 1);
  table.coefficients << FrameMatrix::Zero(10, 1), FrameMatrix::Ones(10, 1);
  table.nodes[0].frame_count = table.nodes[1].frame_count = 10;
  table.nodes[1].first_frame = 10;
  const auto moved = [&](int left, int right) {
    table.nodes[0].phoneme = left;
    table.nodes[1].phoneme = right;
    const FrameMatrixD motion =
        concatenate(table, steps_of(table, {{0, 10}, {1, 10}})).coefficients;
    return std::pair(motion(9, 0), 1.0 - motion(10, 0));
  };
  const auto even = moved(2, 2); // /ae/ and /ae/
  EXPECT_NEAR(even.first, even.second, 1e-12);
  const auto visible_left = moved(1, 3); // /p/, then /k/
  EXPECT_LT(visible_left.first, even.first);
  EXPECT_GT(visible_left.second, even.second);
  const auto visible_right = moved(3, 1);
  EXPECT_NEAR(visible_right.first, visible_left.second, 1e-12);
}

TEST(Concatenate, HasAsManyFramesAsTheTranscriptHasTime) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> duration(0.0, 0.3);
  std::uniform_int_distribution<NodeIndex> any(0, 29);
  std::uniform_int_distribution<int> dice(0, 9);
  for (const double rate : {100.0, 119.88, 120.0, 250.0}) {
    MotionTable table = random_table(random, 5, 6);
    table.rate_hz = rate;
    for (int round = 0; round < 60; ++round) {
      std::vector<ConcatStep> steps;
      double t = 0.0;
      const double pace = round % 4 == 0 ? 0.02 : 1.0; // some far too fast for the frames
      for (int i = 0; i < 30; ++i) {
        ConcatStep step;
        step.is_silence = dice(random) == 0;
        step.node = step.is_silence ? kNoNode : any(random);
        step.start_s = t;
        t += std::round(duration(random) * pace * 1e4) / 1e4;
        step.end_s = t;
        steps.push_back(step);
      }
      const CoefficientMotion motion = concatenate(table, steps);
      EXPECT_EQ(motion.coefficients.rows(), frame_count_to(t, rate));
      EXPECT_TRUE(motion.coefficients.allFinite());
      EXPECT_TRUE(motion.head.empty());
      EXPECT_EQ(motion.rate_hz, rate);
      for (const double fps : {25.0, 29.97, 60.0}) {
        const CoefficientMotion output = resample_motion(motion, fps, t);
        EXPECT_EQ(output.coefficients.rows(), frame_count_to(t, fps));
        EXPECT_TRUE(output.coefficients.allFinite());
      }
      EXPECT_TRUE(concatenate(table, steps).coefficients == motion.coefficients);
    }
  }
}

} // namespace
} // namespace phonomime
