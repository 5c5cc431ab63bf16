// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/concat/concatenate.h"
#include "tests/synth/concat/synthetic_table.h"

#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::random_table;
using test::steps_of;

class ConcatenateEdges : public ::testing::Test {
protected:
  ConcatenateEdges() : random_(21), table_(random_table(random_, 3, 4)) {
    rest_ = table_.pca.project(table_.reference_pose).transpose();
  }

  FrameMatrixD frames(const std::vector<ConcatStep>& steps,
                      const ConcatOptions& options = {}) const {
    return concatenate(table_, steps, options).coefficients;
  }

  std::string refusal(const std::vector<ConcatStep>& steps,
                      const ConcatOptions& options = {}) const {
    try {
      concatenate(table_, steps, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::mt19937 random_;
  MotionTable table_;
  Eigen::RowVectorXd rest_;
};

TEST_F(ConcatenateEdges, RestsThroughASilentTranscript) {
  const FrameMatrixD motion = frames(steps_of(table_, {{kNoNode, 30}, {kNoNode, 20}}));
  ASSERT_EQ(motion.rows(), 51);
  EXPECT_TRUE(motion == rest_.replicate(51, 1));
}

TEST_F(ConcatenateEdges, StartsAndEndsInSpeechWhereThereIsNoSilence) {
  const int count = table_.nodes[5].frame_count;
  const FrameMatrixD motion = frames(steps_of(table_, {{5, count}}));
  ASSERT_EQ(motion.rows(), count + 1);
  EXPECT_TRUE(motion.topRows(count) == table_.node_frames(5).cast<double>());
  EXPECT_TRUE(motion.row(count) == motion.row(count - 1)); // the frame at the very end
}

TEST_F(ConcatenateEdges, DoesNotShowTheNodeOfASilenceUnlessItIsTold) {
  std::vector<ConcatStep> steps = steps_of(table_, {{0, 10}, {kNoNode, 10}, {7, 10}});
  const FrameMatrixD filled = frames(steps);
  steps[1].node = 9;
  EXPECT_TRUE(frames(steps) == filled);

  steps[1].show_node = true;
  table_.nodes[9].frame_count = 10;
  table_.nodes[9].first_frame = 0;
  const FrameMatrixD shown = frames(steps);
  EXPECT_TRUE(shown.middleRows(13, 4) == table_.node_frames(9).middleRows(3, 4).cast<double>());
}

TEST_F(ConcatenateEdges, JoinsAcrossASilenceTooShortForAFrame) {
  std::vector<ConcatStep> steps = steps_of(table_, {{0, 10}, {7, 10}});
  const FrameMatrixD expected = frames(steps);
  ConcatStep pause;
  pause.is_silence = true;
  pause.start_s = steps[0].end_s = 0.0941;
  pause.end_s = steps[1].start_s = 0.0979;
  steps.insert(steps.begin() + 1, pause);
  EXPECT_TRUE(frames(steps) == expected);
}

TEST_F(ConcatenateEdges, GivesEveryPhonemeAFrameWhileThereAreAny) {
  table_.coefficients.rowwise() = Eigen::RowVectorXf::Zero(3);
  table_.nodes[6].frame_count = 1;
  table_.coefficients.row(table_.nodes[6].first_frame).setConstant(8.0F);
  std::vector<ConcatStep> steps = steps_of(table_, {{0, 8}, {6, 0}, {9, 12}});
  steps[1].start_s = steps[0].end_s = 0.0803; // 2 ms between frames 8 and 9
  steps[1].end_s = steps[2].start_s = 0.0823;
  ConcatOptions unsmoothed;
  unsmoothed.smoothing_half_window = 0;
  const FrameMatrixD motion = frames(steps, unsmoothed);
  ASSERT_EQ(motion.rows(), 21);
  for (Eigen::Index k = 0; k < 21; ++k) {
    EXPECT_EQ(motion(k, 0), k == 9 ? 8.0 : 0.0) << k; // of its longer neighbour, the right one
  }
}

TEST_F(ConcatenateEdges, DropsPhonemesOnlyWhereThereIsNoFrameLeft) {
  const FrameMatrixD motion = frames(steps_of(table_, {{0, 1}, {5, 0}, {1, 1}}));
  ASSERT_EQ(motion.rows(), 3);
  EXPECT_TRUE(motion.row(1) == motion.row(2));
}

TEST_F(ConcatenateEdges, StretchesOneFrameOverTenSeconds) {
  table_.nodes[2].frame_count = 1;
  const FrameMatrixD motion = frames(steps_of(table_, {{2, 1000}}));
  EXPECT_TRUE(motion == table_.node_frames(2).cast<double>().replicate(1001, 1));
}

TEST_F(ConcatenateEdges, TakesATranscriptOfNoTime) {
  EXPECT_TRUE(frames(steps_of(table_, {{kNoNode, 0}})) == rest_);
  EXPECT_TRUE(frames(steps_of(table_, {{3, 0}})) == rest_);
}

TEST_F(ConcatenateEdges, RefusesStepsThatBreakTheContract) {
  const auto good = steps_of(table_, {{0, 10}, {kNoNode, 10}, {7, 10}});
  EXPECT_EQ(refusal(good), "");
  EXPECT_NE(refusal({}), "");

  auto steps = good;
  steps[2].node = kNoNode;
  EXPECT_EQ(refusal(steps), "step 2: a step has no node to show");
  steps[2].node = table_.node_count();
  EXPECT_EQ(refusal(steps), "step 2: a step has no node to show");
  steps = good;
  steps[1].show_node = true;
  EXPECT_EQ(refusal(steps), "step 1: a step has no node to show");
  steps = good;
  steps[1].start_s += 0.01;
  EXPECT_EQ(refusal(steps), "step 1: a step does not start where the one before ends");
  steps = good;
  steps[0].start_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(steps), "step 0: a step does not start where the one before ends");
  steps = good;
  steps[2].end_s = 0.05;
  EXPECT_EQ(refusal(steps), "step 2: a step ends before it starts");
  steps[2].end_s = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(steps), "step 2: a step ends before it starts");
  steps[2].end_s = 1e12;
  EXPECT_EQ(refusal(steps), "the transcript is too long (expected at most " +
                                format_number(1e7 / table_.rate_hz) + " s, got 1000000000000 s)");

  ConcatOptions options;
  options.smoothing_half_window = -1;
  EXPECT_NE(refusal(good, options), "");
  options = {};
  options.silence.rest_within_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(good, options), "");
  table_.reference_pose.resize(1);
  EXPECT_NE(refusal(good), "");
}

} // namespace
} // namespace phonomime
