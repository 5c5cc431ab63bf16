// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/suspect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace phonomime {
namespace {

TEST(LogHistogram, GivesMedianSpreadAndQuantileToItsResolution) {
  std::mt19937 random(2);
  std::lognormal_distribution<double> speeds(3.0, 0.7);
  std::vector<double> values(20001);
  LogHistogram halves[2];
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = speeds(random);
    halves[i % 2].add(values[i]);
  }
  halves[0].add(halves[1]);
  halves[0].add(0.0);
  std::sort(values.begin(), values.end());
  const LogSpread spread = halves[0].spread();
  EXPECT_EQ(spread.count, 20001);
  EXPECT_NEAR(spread.median, std::log2(values[10000]), 1.0 / 16);
  EXPECT_NEAR(spread.sigma, 0.7 / std::log(2.0), 0.1);
  EXPECT_NEAR(std::log2(halves[0].quantile(0.99)), std::log2(values[19800]), 1.0 / 8);
  EXPECT_EQ(LogHistogram().quantile(0.5), 0.0);
}

TEST(Suspect, FrozenMarkersAreFoundOneByOneAndWeightsAllTogether) {
  FrameMatrixD frames(50, 6);
  std::mt19937 random(4);
  for (double& value : frames.reshaped()) {
    value = static_cast<double>(random() % 1000);
  }
  for (Eigen::Index k = 21; k < 30; ++k) {
    frames.row(k).tail(3) = frames.row(20).tail(3);
  }
  frames.row(41).head(3) = frames.row(40).head(3); // two equal frames are nothing unusual
  const std::vector<FrozenRun> runs = frozen_runs(frames, 3, 50.0);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].group, 1);
  EXPECT_EQ(runs[0].first_frame, 20);
  EXPECT_EQ(runs[0].frame_count, 10);
  EXPECT_TRUE(frozen_runs(frames, 1, 50.0).empty());
  for (Eigen::Index k = 21; k < 32; ++k) {
    frames.row(k) = frames.row(20);
  }
  ASSERT_EQ(frozen_runs(frames, 1, 50.0).size(), 1u);
  EXPECT_EQ(frozen_runs(frames, 1, 50.0)[0].group, -1);
}

TEST(Suspect, NodesAreMarkedWhereTheFaultIsAndSayWhy) {
  Layout layout;
  layout.groups = {{"a", {}}, {"b", {}}};
  RecordedSentence recorded;
  recorded.clock = {.rate_hz = 50.0, .start_s = 0.0};
  recorded.frames.resize(60, 6);
  for (Eigen::Index k = 0; k < 60; ++k) {
    recorded.frames.row(k).setConstant(std::sin(0.1 * static_cast<double>(k)));
  }
  recorded.frames(35, 3) += 40.0; // a spike of marker b
  const char* names[] = {"aa", "b", "t"};
  std::vector<ImportedNode> nodes(3);
  for (int i = 0; i < 3; ++i) {
    recorded.rows.push_back({.phoneme = {.name = names[i], .viseme = names[i]},
                             .start_s = 0.4 * i,
                             .end_s = 0.4 * (i + 1)});
    nodes[static_cast<std::size_t>(i)].row = i;
    nodes[static_cast<std::size_t>(i)].first_frame = 40 * i;
    nodes[static_cast<std::size_t>(i)].frame_count = 40;
  }
  const std::vector<Gap> gaps{{0, 2, 9, GapAction::marked}, {1, 4, 2, GapAction::filled}};
  SuspectLimits limits;
  limits.speed = {100.0, 100.0};
  limits.duration_s["t"] = {0.02, 0.2};
  const FrameMatrixD speeds = group_speeds(recorded.frames, 3, 50.0);
  const auto counts = mark_suspects(
      nodes, {.recorded = &recorded, .speeds = &speeds, .gaps = &gaps, .rate_hz = 100.0}, limits,
      layout);
  EXPECT_EQ(counts, (std::array<std::int64_t, 4>{1, 1, 0, 1}));
  ASSERT_EQ(nodes[0].suspect.size(), 1u);
  EXPECT_EQ(nodes[0].suspect[0], "gap: a missing from 0.04 s for 0.18 s");
  ASSERT_EQ(nodes[1].suspect.size(), 1u);
  EXPECT_EQ(nodes[1].suspect[0].substr(0, 8), "jump: b ");
  ASSERT_EQ(nodes[2].suspect.size(), 1u);
  EXPECT_EQ(nodes[2].suspect[0], "duration: t of 0.4 s, usual 0.02 s to 0.2 s");
}

TEST(Suspect, LimitsFollowWhatIsUsualNotTheFaults) {
  UsualMotion usual;
  usual.speeds.resize(2);
  for (int i = 0; i < 10000; ++i) {
    usual.speeds[0].add(i < 9950 ? 80.0 : 5000.0);
    usual.speeds[1].add(1.0);
  }
  for (int i = 0; i < 100; ++i) {
    usual.durations["ah"].add(i < 95 ? 0.08 : 3.0);
  }
  usual.durations["rare"].add(0.1);
  const SuspectLimits limits = suspect_limits(usual, LayoutKind::markers);
  EXPECT_NEAR(limits.speed[0], 240.0, 20.0);
  EXPECT_EQ(limits.speed[1], 100.0);
  EXPECT_LT(limits.duration_s.at("ah").second, 0.3);
  EXPECT_LT(limits.duration_s.at("ah").first, 0.08);
  EXPECT_FALSE(limits.duration_s.contains("rare"));
}

} // namespace
} // namespace phonomime
