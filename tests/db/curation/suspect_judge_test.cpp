// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/suspect_judge.h"

#include "db/types/errors.h"
#include "tests/db/curation/made_face.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::made_sentence;
using test::marker;

std::vector<StoredSentence> sentences(int count = 20) {
  // The face moves in the same ways in all of them, at another time.
  static const FrameMatrix motion = test::made_motion(6000, 1);
  std::vector<StoredSentence> made;
  for (int i = 0; i < count; ++i) {
    made.push_back(made_sentence("u" + std::to_string(i), 300, 1));
    made.back().id = i;
    made.back().channels = motion.middleRows(300 * i, 300);
  }
  return made;
}

std::vector<JudgedNode> judged(const std::vector<StoredSentence>& all, int threads = 1) {
  SuspectJudge judge(test::made_face(), test::kFaceRate_hz);
  for (const StoredSentence& sentence : all) {
    judge.learn(sentence);
  }
  judge.settle(threads);
  std::vector<SuspectJudge::Look> looks;
  for (const StoredSentence& sentence : all) {
    looks.push_back(judge.look(sentence));
  }
  return judge.judge(std::move(looks), threads);
}

const SuspectMark* find_mark(const std::vector<JudgedNode>& nodes, std::size_t sentence, int row,
                             std::string_view reason) {
  for (const JudgedNode& node : nodes) {
    if (node.sentence == sentence && node.row == row) {
      const auto mark = std::ranges::find(node.marks, reason, &SuspectMark::reason);
      return mark == node.marks.end() ? nullptr : &*mark;
    }
  }
  return nullptr;
}

TEST(SuspectJudge, CleanSentencesHaveNone) {
  EXPECT_TRUE(judged(sentences()).empty());
}

TEST(SuspectJudge, EachFaultMarksTheNodesItLiesInAndSaysWhy) {
  std::vector<StoredSentence> all = sentences();
  for (Eigen::Index k = 95; k < 105; ++k) { // rows 9 (90 to 99) and 10
    marker(all[3].channels, k, 12)[1] += 6.0F;
  }
  for (Eigen::Index k = 50; k < 60; ++k) { // row 5
    const Eigen::RowVector3f kept = marker(all[4].channels, k, 6);
    marker(all[4].channels, k, 6) = marker(all[4].channels, k, 18);
    marker(all[4].channels, k, 18) = kept;
  }
  for (Eigen::Index k = 120; k < 130; ++k) { // row 12
    marker(all[5].channels, k, 0) = marker(all[5].channels, 120, 0);
  }
  all[6].nodes[6].duration_s = 1.5;                     // row 7
  all[7].channels.middleRows(150, 10).array() += 25.0F; // row 15: the whole face
  const std::vector<JudgedNode> nodes = judged(all);
  for (const int row : {9, 10}) {
    const SuspectMark* jump = find_mark(nodes, 3, row, suspect::kJump);
    ASSERT_NE(jump, nullptr) << row;
    EXPECT_EQ(jump->groups.front(), "m12");
    EXPECT_EQ(jump->first_frame, 95);
    EXPECT_EQ(jump->frame_count, 10);
    EXPECT_GT(jump->score, 3.0);
    EXPECT_EQ(jump->text.substr(0, 12), "jump: m12 6.") << jump->text;
    EXPECT_NE(jump->text.find("from 0.95 s for 0.10 s (usual 0.0"), std::string::npos)
        << jump->text;
  }
  EXPECT_EQ(find_mark(nodes, 3, 11, suspect::kJump), nullptr);
  const SuspectMark* swapped = find_mark(nodes, 4, 5, suspect::kSwapped);
  ASSERT_NE(swapped, nullptr);
  std::vector<std::string> both = swapped->groups;
  std::ranges::sort(both);
  EXPECT_EQ(both, (std::vector<std::string>{"m18", "m6"}));
  const SuspectMark* frozen = find_mark(nodes, 5, 12, suspect::kFrozen);
  ASSERT_NE(frozen, nullptr);
  EXPECT_EQ(frozen->groups, std::vector<std::string>{"m0"});
  EXPECT_EQ(frozen->origin, SuspectOrigin::channels);
  ASSERT_NE(find_mark(nodes, 6, 7, suspect::kDuration), nullptr);
  EXPECT_NE(find_mark(nodes, 6, 7, suspect::kDuration)->text.find("of 1.5 s"), std::string::npos);
  ASSERT_NE(find_mark(nodes, 7, 15, suspect::kPose), nullptr);
  ASSERT_NE(find_mark(nodes, 7, 15, suspect::kJump), nullptr); // in one frame, there
  // Nothing else, but the node after the whole face's fault, into which it jumps back.
  for (const JudgedNode& node : nodes) {
    EXPECT_TRUE(node.sentence >= 3 && node.sentence <= 7) << node.sentence;
    EXPECT_TRUE(std::ranges::is_sorted(node.marks, {}, &SuspectMark::reason));
    for (const SuspectMark& mark : node.marks) {
      EXPECT_GE(mark.score, 1.0);
      EXPECT_FALSE(mark.text.empty());
    }
  }
  EXPECT_LE(nodes.size(), 8u);
}

TEST(SuspectJudge, TheSameAtAnyThreadCount) {
  std::vector<StoredSentence> all = sentences();
  for (std::size_t i = 0; i < all.size(); ++i) {
    marker(all[i].channels, 40 + static_cast<Eigen::Index>(i), 7)[0] += 5.0F;
  }
  const std::vector<JudgedNode> one = judged(all, 1), two = judged(all, 2);
  ASSERT_EQ(one.size(), two.size());
  EXPECT_GE(one.size(), all.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].row, two[i].row);
    EXPECT_EQ(one[i].marks, two[i].marks);
  }
}

// A pruned node is no example of what is usual; it is judged like the others.
TEST(SuspectJudge, PrunedNodesTeachNothing) {
  std::vector<StoredSentence> all = sentences();
  for (std::size_t i = 0; i < all.size(); ++i) { // two nodes in three are ruined
    for (StoredSentence::Node& node : all[i].nodes) {
      if (node.row % 3 != 0) {
        node.pruned = true;
        for (Eigen::Index k = node.first_frame; k < node.first_frame + node.frame_count; ++k) {
          marker(all[i].channels, k, 12)[1] += static_cast<float>((k * 7) % 11) - 5.0F;
        }
      }
    }
  }
  const std::vector<JudgedNode> nodes = judged(all);
  std::size_t pruned = 0;
  for (const JudgedNode& node : nodes) {
    pruned += node.row % 3 != 0;
  }
  EXPECT_GT(pruned, 9 * all.size() * 19 / 10);
  for (StoredSentence& sentence : all) {
    for (StoredSentence::Node& node : sentence.nodes) {
      node.pruned = false;
    }
  }
  EXPECT_LT(judged(all).size(), nodes.size() / 2); // taken for usual
}

TEST(SuspectJudge, StandsSentencesWithoutNodesAndSpeakersWithLittle) {
  std::vector<StoredSentence> all = sentences(2);
  all[1].speaker = "bob";
  all[1].nodes.clear();
  all[1].channels.conservativeResize(1, Eigen::NoChange);
  all[1].frame_has_gap.resize(1);
  EXPECT_TRUE(judged(all).empty());
  EXPECT_TRUE(judged({}).empty());
  SuspectJudge judge(test::made_face(), test::kFaceRate_hz);
  judge.settle(1);
  EXPECT_THROW(judge.look(all[0]), InternalError);
}

} // namespace
} // namespace phonomime
