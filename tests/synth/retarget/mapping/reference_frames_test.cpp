// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/reference_frames.h"
#include "tests/synth/style/made_table.h"

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

// Three phonemes in two emotions, many nodes of each, and one frame far from all others.
MotionTable spoken_table() {
  MadeTable made;
  for (int i = 0; i < 12; ++i) {
    made.say("s" + std::to_string(i), i % 3 == 0 ? "anger" : "neutral",
             {{"a", 3}, {"b", 4 + i % 2}, {"c", 1}});
  }
  std::mt19937 random(3);
  for (float& value : made.table.coefficients.reshaped()) {
    value += 0.5F * static_cast<float>(random()) / 4294967296.0F;
  }
  made.table.coefficients(20, 1) += 100.0F;
  return made.table;
}

std::vector<Eigen::Index> rows_of(const MotionTable& table,
                                  const std::vector<ProposedFrame>& references) {
  std::vector<Eigen::Index> rows;
  for (const ProposedFrame& reference : references) {
    rows.push_back(table.nodes[static_cast<std::size_t>(reference.node)].first_frame +
                   reference.frame);
  }
  return rows;
}

} // namespace

TEST(ReferenceFrames, AreOneForEachVisemeAndEmotionThenTheFarthest) {
  const MotionTable table = spoken_table();
  const auto references = propose_references(table, {.dimensions = 2, .extremes = 3});
  ASSERT_EQ(references.size(), 6U + 2U * 3U);
  std::set<std::pair<int, int>> classes;
  for (std::size_t i = 0; i < 6; ++i) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(references[i].node)];
    EXPECT_FALSE(references[i].extreme);
    EXPECT_EQ(references[i].frame, node.frame_count / 2) << "the middle frame";
    classes.insert({node.viseme, node.emotion});
  }
  EXPECT_EQ(classes.size(), 6U);
  const auto rows = rows_of(table, references);
  EXPECT_NE(std::ranges::find(rows, 20), rows.end()) << "the frame far from all others";
  // Each extreme is, among its emotion's frames, the farthest from all before it.
  for (std::size_t i = 6; i < references.size(); ++i) {
    EXPECT_TRUE(references[i].extreme);
    const auto emotion = table.nodes[static_cast<std::size_t>(references[i].node)].emotion;
    EXPECT_EQ(emotion, i < 9 ? 0 : 1);
    const auto nearest = [&](Eigen::Index row) {
      double least = 1e9;
      for (std::size_t k = 0; k < i; ++k) {
        least = std::min<double>(
            least, (table.coefficients.row(row) - table.coefficients.row(rows[k])).norm());
      }
      return least;
    };
    for (const MotionNode& node : table.nodes) {
      for (int f = 0; f < node.frame_count && node.emotion == emotion; ++f) {
        EXPECT_LE(nearest(node.first_frame + f), nearest(rows[i]) + 1e-5);
      }
    }
  }
}

TEST(ReferenceFrames, CoverageIsWhatBruteForceFinds) {
  const MotionTable table = spoken_table();
  auto references = propose_references(table, {.dimensions = 2, .extremes = 1});
  references.erase(references.begin() + 2); // a class without a frame
  const ReferenceCoverage coverage = coverage_of(table, references, 2);
  EXPECT_EQ(coverage.classes, 6);
  EXPECT_EQ(coverage.classes_met, 5);
  double left = 0.0;
  double farthest = 0.0;
  for (Eigen::Index row = 0; row < table.coefficients.rows(); ++row) {
    double least = 1e9;
    for (const Eigen::Index reference : rows_of(table, references)) {
      least = std::min<double>(
          least, (table.coefficients.row(row) - table.coefficients.row(reference)).squaredNorm());
    }
    left += least;
    farthest = std::max(farthest, std::sqrt(least));
  }
  const Eigen::MatrixXd all = table.coefficients.cast<double>();
  const double variance = (all.rowwise() - all.colwise().mean()).squaredNorm();
  EXPECT_NEAR(coverage.explained, 1.0 - left / variance, 1e-6);
  EXPECT_NEAR(coverage.farthest, farthest, 1e-5);
  EXPECT_LE(coverage.median, coverage.percentile_95);
  EXPECT_LE(coverage.percentile_95, coverage.farthest);
}

TEST(ReferenceFrames, MoreOfThemCoverMore) {
  const MotionTable table = spoken_table();
  double before = -1.0;
  for (const int extremes : {0, 1, 3, 9}) {
    const auto references = propose_references(table, {.dimensions = 2, .extremes = extremes});
    const double explained = coverage_of(table, references, 2).explained;
    EXPECT_GT(explained, before);
    before = explained;
  }
  const auto all = propose_references(table, {.dimensions = 2, .extremes = 1000});
  EXPECT_NEAR(coverage_of(table, all, 2).explained, 1.0, 1e-12);
}

} // namespace phonomime::test
