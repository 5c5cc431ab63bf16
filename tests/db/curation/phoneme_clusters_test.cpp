// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/phoneme_clusters.h"

#include "tests/db/curation/made_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// `count` nodes of one cluster, from as many sentences, whose poses are a few numbers each.
std::vector<NodeMeasures> nodes(std::size_t count, const std::string& cluster = "ann/aa") {
  std::mt19937 random(5);
  const auto some = [&] { return static_cast<double>(random() % 1000) / 1000.0; };
  std::vector<NodeMeasures> made;
  for (std::size_t i = 0; i < count; ++i) {
    NodeMeasures node;
    node.cluster = cluster;
    node.sentence = i;
    node.duration_s = 0.08 * std::exp2(0.6 * (some() - 0.5));
    node.step = 0.5 + 0.5 * some();
    node.step_size = 2.0 * node.step;
    node.step_group = 3;
    node.first = Eigen::VectorXf::NullaryExpr(9, [&] { return static_cast<float>(4.0 * some()); });
    node.last = Eigen::VectorXf::NullaryExpr(9, [&] { return static_cast<float>(4.0 * some()); });
    made.push_back(node);
  }
  return made;
}

template <typename Verdict>
std::size_t count_beyond(const std::vector<std::optional<Verdict>>& verdicts) {
  return static_cast<std::size_t>(std::ranges::count_if(verdicts, [](const auto& verdict) {
    if constexpr (std::is_same_v<Verdict, PoseVerdict>) {
      return verdict && verdict->verdict.score > 1.0;
    } else {
      return verdict && verdict->score > 1.0;
    }
  }));
}

TEST(PhonemeClusters, DurationsFarFromTheMedianAreBeyondTheLimit) {
  std::vector<NodeMeasures> cluster = nodes(60);
  cluster[7].duration_s = 0.5;
  cluster[8].duration_s = 0.01;
  const auto verdicts = judge_durations(cluster);
  EXPECT_EQ(count_beyond(verdicts), 2u);
  EXPECT_GT(verdicts[7]->score, 1.0);
  EXPECT_GT(verdicts[8]->score, 1.0);
  EXPECT_EQ(verdicts[7]->count, 60u);
  EXPECT_NEAR(verdicts[7]->usual, 0.08, 0.01);
  // The score is where the limits say it is.
  EXPECT_GT(verdicts[7]->value, verdicts[7]->most);
  EXPECT_LT(verdicts[8]->value, verdicts[8]->least);
}

TEST(PhonemeClusters, AStepIsJudgedByItsCluster) {
  std::vector<NodeMeasures> both = nodes(60, "ann/aa");
  for (NodeMeasures& node : nodes(60, "ann/b")) {
    node.step *= 20.0; // a plosive moves like that
    node.step_size *= 20.0;
    both.push_back(node);
  }
  both[7].step = 14.0;
  both[7].step_size = 28.0;
  const auto verdicts = judge_steps(both);
  EXPECT_EQ(count_beyond(verdicts), 1u);
  EXPECT_GT(verdicts[7]->score, 1.0);
  EXPECT_DOUBLE_EQ(verdicts[7]->value, 28.0);
  EXPECT_NEAR(verdicts[7]->usual, 1.5, 0.2);
  EXPECT_LT(verdicts[7]->most, 28.0);
}

TEST(PhonemeClusters, SmallClustersAndThoseWithoutMeasureSayNothing) {
  for (const auto& verdict : judge_durations(nodes(19))) {
    EXPECT_FALSE(verdict);
  }
  std::vector<NodeMeasures> cluster = nodes(30);
  for (std::size_t i = 0; i < 11; ++i) {
    cluster[i].left_out = true;
  }
  EXPECT_FALSE(judge_durations(cluster)[0]);
  EXPECT_FALSE(judge_steps(cluster)[0]);
  EXPECT_FALSE(judge_poses(cluster, LayoutKind::markers, 1)[0]);
  cluster[0].left_out = false;
  EXPECT_TRUE(judge_durations(cluster)[1]); // and the others are judged
}

// The nearest boundary of another sentence, one by one; more nodes than are compared at first.
TEST(PhonemeClusters, APosesDistanceIsThatOfTheNearestOther) {
  std::vector<NodeMeasures> cluster = nodes(500);
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    cluster[i].sentence = i / 2; // two nodes a sentence
  }
  cluster[40].last.array() += 40.0F;
  cluster[41].first = cluster[40].last; // but of the same sentence
  cluster[90].first.array() -= 30.0F;
  cluster[91].last = cluster[90].first;
  cluster[301].first = cluster[90].first; // no reference, and of another sentence
  const auto verdicts = judge_poses(cluster, LayoutKind::markers, 1);
  const auto nearest = [&](std::size_t i) {
    double most = 0.0;
    for (const Eigen::VectorXf* pose : {&cluster[i].first, &cluster[i].last}) {
      double least = std::numeric_limits<double>::infinity();
      for (const NodeMeasures& other : cluster) {
        if (other.sentence != cluster[i].sentence) {
          least = std::min({least, static_cast<double>((*pose - other.first).norm()),
                            static_cast<double>((*pose - other.last).norm())});
        }
      }
      most = std::max(most, least);
    }
    return most / std::sqrt(3.0); // three groups
  };
  EXPECT_NEAR(verdicts[40]->verdict.value, nearest(40), 1e-5);
  EXPECT_GT(verdicts[40]->verdict.score, 1.0);
  EXPECT_TRUE(verdicts[40]->last);
  EXPECT_GT(verdicts[41]->verdict.score, 1.0);
  EXPECT_FALSE(verdicts[41]->last);
  // Far from the cluster, but not from every other.
  EXPECT_NEAR(verdicts[90]->verdict.value, nearest(90), 1e-5);
  EXPECT_LT(verdicts[90]->verdict.score, 1.0);
  EXPECT_EQ(count_beyond(verdicts), 2u);
}

TEST(PhonemeClusters, PosesAreTheSameWithAnyNumberOfThreads) {
  std::vector<NodeMeasures> both = nodes(300);
  for (const NodeMeasures& node : nodes(100, "ann/b")) {
    both.push_back(node);
  }
  const auto one = judge_poses(both, LayoutKind::markers, 1);
  const auto two = judge_poses(both, LayoutKind::markers, 2);
  for (std::size_t i = 0; i < both.size(); ++i) {
    ASSERT_EQ(one[i]->verdict.score, two[i]->verdict.score);
  }
}

TEST(PhonemeClusters, PosesAreComparedOnSixteenGroupsAtMost) {
  EXPECT_EQ(pose_groups(test::made_face()).size(), 13u); // every second of 25
  Layout four = test::made_face();
  four.groups.resize(4);
  EXPECT_EQ(pose_groups(four), (std::vector<int>{0, 1, 2, 3}));
  four.groups.resize(91);
  EXPECT_LE(pose_groups(four).size(), 16u);
}

} // namespace
} // namespace phonomime
