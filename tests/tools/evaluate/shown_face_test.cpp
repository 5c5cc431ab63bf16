// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/shown_face.h"

#include "tests/tools/evaluate/made_evaluation.h"

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

using Edges = std::vector<std::pair<int, int>>;

TEST(ShownFace, LipsThatMeetAtRestAreNoNeighbours) {
  Layout layout; // three markers on each lip, 4 mm apart
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    layout.groups.push_back({name, {Region::lips}});
  }
  layout.groups.push_back({"nose", {Region::nose}});
  ShownSentence sentence;
  sentence.recorded = FrameMatrix::Zero(100, 21);
  for (int g = 0; g < 6; ++g) {
    sentence.recorded.col(3 * g).setConstant(4.0F * static_cast<float>(g % 3));
    sentence.recorded.col(3 * g + 1).setConstant(g < 3 ? 0.5F : -0.5F);
  }
  EXPECT_EQ(shown_face(layout, {sentence}).edges,
            (Edges{{0, 1}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {4, 5}}));
  sentence.recorded.block(50, 1, 10, 1).setConstant(12.0F); // they open
  sentence.recorded.block(50, 4, 10, 1).setConstant(12.0F);
  sentence.recorded.block(50, 7, 10, 1).setConstant(12.0F);
  EXPECT_EQ(shown_face(layout, {sentence}).edges,
            (Edges{{0, 1}, {0, 2}, {1, 2}, {3, 4}, {3, 5}, {4, 5}}));
}

TEST(ShownFace, TracesTheLandmarksAndWhatMovesMost) {
  Layout layout = made_layout();
  layout.groups.push_back({"cheek_still", {Region::cheeks}});
  layout.groups.push_back({"cheek_moving", {Region::cheeks}});
  ShownSentence sentence;
  sentence.recorded = FrameMatrix::Zero(40, 30);
  for (Eigen::Index k = 0; k < 40; ++k) {
    sentence.recorded(k, 3 * 9) = static_cast<float>(k % 7);
    sentence.recorded(k, 3 * skull) = static_cast<float>(k % 9); // rigid: not of interest
  }
  EXPECT_EQ(
      shown_face(layout, {sentence}).traced,
      (std::vector<int>{lower_lip, upper_lip, right_corner, left_corner, chin, 9, brow, lid}));
  EXPECT_EQ(shown_face(layout, {sentence}).pose.size(), 30);
}

} // namespace
} // namespace phonomime::test
