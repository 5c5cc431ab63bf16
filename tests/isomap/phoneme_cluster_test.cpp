// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/phoneme_cluster.h"
#include "tests/isomap/point_sets.h"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Two sentences "aa w aa" and "w aa iy": coefficients count up, so that a frame tells its row.
MotionTable small_table() {
  MotionTable table;
  table.rate_hz = 100.0;
  for (const char* name : {"pau", "aa", "w", "iy"}) {
    table.phonemes.push_back({name, name, Visibility::intermediate});
  }
  table.emotions = {"happiness", "neutral"};
  table.sentences = {{"s", "happiness", "a", ""}, {"s", "neutral", "b", ""}};
  struct Row {
    std::int32_t phoneme, previous, next, sentence, frames;
  };
  std::int64_t first = 0;
  for (const Row& row : {Row{1, 0, 2, 0, 3}, Row{2, 1, 1, 0, 2}, Row{1, 2, 0, 0, 1},
                         Row{2, 0, 1, 1, 4}, Row{1, 2, 3, 1, 5}, Row{3, 1, 0, 1, 2}}) {
    table.nodes.push_back({.phoneme = row.phoneme,
                           .emotion = row.sentence,
                           .sentence = row.sentence,
                           .order = static_cast<std::int32_t>(table.nodes.size()),
                           .previous_phoneme = row.previous,
                           .next_phoneme = row.next,
                           .first_frame = first,
                           .frame_count = row.frames});
    first += row.frames;
  }
  table.coefficients.resize(first, 2);
  for (Eigen::Index i = 0; i < first; ++i) {
    table.coefficients.row(i) << static_cast<float>(i), static_cast<float>(-i);
  }
  return table;
}

TEST(PhonemeCluster, HoldsEveryFrameOfItsPhoneme) {
  const PhonemeCluster cluster = gather_cluster(small_table(), 1);
  ASSERT_EQ(cluster.nodes.size(), 3U);
  EXPECT_EQ(cluster.nodes[0].node, 0);
  EXPECT_EQ(cluster.nodes[1].node, 2);
  EXPECT_EQ(cluster.nodes[2].node, 4);
  std::vector<float> rows;
  for (Eigen::Index i = 0; i < cluster.frame_count(); ++i) {
    rows.push_back(cluster.frames(i, 0));
    EXPECT_EQ(cluster.frames(i, 1), -cluster.frames(i, 0));
  }
  EXPECT_EQ(rows, (std::vector<float>{0, 1, 2, 5, 10, 11, 12, 13, 14}));
  EXPECT_EQ(cluster.node_of, (std::vector<std::int32_t>{0, 0, 0, 1, 2, 2, 2, 2, 2}));
  EXPECT_EQ(cluster.emotion_of, (std::vector<std::int32_t>{0, 0, 0, 0, 1, 1, 1, 1, 1}));
  EXPECT_EQ(cluster.relative_time(0), 0.0);
  EXPECT_EQ(cluster.relative_time(1), 0.5);
  EXPECT_EQ(cluster.relative_time(3), 0.5) << "a node of one frame is in its middle";
  EXPECT_EQ(cluster.relative_time(7), 0.75);
}

TEST(PhonemeCluster, OfAPhonemeThatWasNotRecordedIsEmpty) {
  const PhonemeCluster cluster = gather_cluster(small_table(), 0);
  EXPECT_TRUE(cluster.nodes.empty());
  EXPECT_EQ(cluster.frame_count(), 0);
  EXPECT_TRUE(time_correct_frames(cluster, 0.5).empty());
  EXPECT_TRUE(context_correct_nodes(cluster, 1, 2).empty());
}

TEST(PhonemeCluster, TimeCorrectFramesAreAtTheRelativeTime) {
  const PhonemeCluster cluster = gather_cluster(small_table(), 1);
  const MapPlaces places = cluster.frames.cast<double>();
  const auto where = [&](double relative_time) {
    const MapPlaces at = places_of(time_correct_frames(cluster, relative_time), places);
    return std::vector<double>{at(0, 0), at(1, 0), at(2, 0)};
  };
  EXPECT_EQ(where(0.0), (std::vector<double>{0.0, 5.0, 10.0}));
  EXPECT_EQ(where(1.0), (std::vector<double>{2.0, 5.0, 14.0}));
  EXPECT_EQ(where(0.375), (std::vector<double>{0.75, 5.0, 11.5}));
  EXPECT_EQ(where(-3.0), where(0.0));
  EXPECT_EQ(where(7.0), where(1.0));
}

TEST(PhonemeCluster, ContextCorrectNodesHaveTheTriphone) {
  const PhonemeCluster cluster = gather_cluster(small_table(), 1);
  EXPECT_EQ(context_correct_nodes(cluster, 0, 2), std::vector<std::int32_t>{0});
  EXPECT_EQ(context_correct_nodes(cluster, 2, 3), std::vector<std::int32_t>{2});
  EXPECT_TRUE(context_correct_nodes(cluster, 2, 2).empty());
}

TEST(PhonemeCluster, FramesThatAreNotOnTheMapArePlacedByTheirNeighbours) {
  std::mt19937 random(81);
  const FrameMatrix points = test::uniform_points(random, 200, 2);
  MapPlaces places = points.cast<double>(); // the map is the points: places should be kept
  const MapPlaces again = place_frames(points, places, points, 1);
  EXPECT_EQ(again, places);
  const FrameMatrix others = (0.25F + 0.5F * test::uniform_points(random, 50, 2).array()).matrix();
  const MapPlaces placed = place_frames(points, places, others, 1);
  EXPECT_LT((placed - others.cast<double>()).rowwise().norm().maxCoeff(), 0.15);
  EXPECT_EQ(placed, place_frames(points, places, others, 2));

  FrameMatrix two(2, 1);
  two << 0.0F, 4.0F;
  MapPlaces ends(2, 2);
  ends << 0.0, 0.0, 8.0, 0.0;
  // One over distance: (0 / 1 + 8 / 3) / (1 / 1 + 1 / 3)
  EXPECT_NEAR(place_frames(two, ends, FrameMatrix::Constant(1, 1, 1.0F), 1)(0, 0), 2.0, 1e-12);
  EXPECT_EQ(place_frames(FrameMatrix(0, 1), MapPlaces(0, 2), two, 1).norm(), 0.0);
}

} // namespace
} // namespace phonomime
