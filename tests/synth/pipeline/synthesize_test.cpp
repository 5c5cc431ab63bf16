// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/json_file.h"
#include "synth/pipeline/explain.h"
#include "synth/pipeline/result_json.h"
#include "synth/pipeline/synthesize.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

const CostWeights kWeights{1.0, 0.2, 20.0, 0.4, 10.0, 10.0, 500.0};

MotionTable table(std::uint64_t seed) {
  test::Draw draw(seed);
  test::TableShape shape;
  shape.sentences = 20;
  shape.phonemes = 30;
  shape.longest_sentence = 9;
  return test::random_table(shape, draw);
}

// The longest captured run of the table, said again with the timing it was recorded with.
std::vector<NodeIndex> longest_run(const MotionTable& t) {
  std::vector<NodeIndex> longest;
  for (NodeIndex start = 0; start < t.node_count(); ++start) {
    std::vector<NodeIndex> run;
    for (NodeIndex node = start; node != kNoNode;
         node = t.nodes[static_cast<std::size_t>(node)].successor) {
      run.push_back(node);
    }
    if (run.size() > longest.size()) {
      longest = run;
    }
  }
  return longest;
}

SynthesisInput said_again(const MotionTable& t, const std::vector<NodeIndex>& run) {
  SynthesisInput input;
  double time_s = 0.0;
  for (const NodeIndex node : run) {
    const MotionNode& info = t.nodes[static_cast<std::size_t>(node)];
    const double end_s = time_s + info.frame_count / t.rate_hz;
    input.transcript.push_back({.phoneme = t.phonemes[static_cast<std::size_t>(info.phoneme)],
                                .start_s = time_s,
                                .end_s = end_s});
    input.emotions.push_back({.emotion = t.emotions[static_cast<std::size_t>(info.emotion)]});
    time_s = end_s;
  }
  input.weights = kWeights;
  input.fps = t.rate_hz;
  return input;
}

TEST(Synthesize, ARecordedSentenceComesBackAsItWasRecorded) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const MotionTable t = table(seed);
    const std::vector<NodeIndex> run = longest_run(t);
    ASSERT_GE(run.size(), 5u);
    const SynthesisInput input = said_again(t, run);
    ViterbiSearch search(t, input.weights);
    const SynthesisResult result = synthesize(t, search, input);
    EXPECT_EQ(result.cost, 0.0);
    Eigen::Index frame = 0;
    for (std::size_t i = 0; i < run.size(); ++i) {
      EXPECT_EQ(result.rows[i].node, run[i]);
      EXPECT_EQ(result.rows[i].captured, i > 0);
      const FrameMatrixD recorded = t.node_frames(run[i]).cast<double>();
      EXPECT_EQ(result.output.coefficients.middleRows(frame, recorded.rows()), recorded);
      frame += recorded.rows();
    }
  }
}

TEST(Synthesize, TheResultIsWhatItsSchemaSaysAndCanBeExplained) {
  const MotionTable t = table(3);
  SynthesisInput input = said_again(t, longest_run(t));
  input.transcript[2].phoneme = t.phonemes[0]; // an inner pause
  input.search.runners_up = 2;
  ViterbiSearch search(t, input.weights);
  const SynthesisResult result = synthesize(t, search, input);
  const nlohmann::ordered_json json = result_to_json(t, result);
  const nlohmann::json read = parse_json_as("result", json.dump(), "r.json");
  ASSERT_EQ(read["path"].size(), input.transcript.size());
  EXPECT_FALSE(read["path"][2]["captured"].get<bool>());
  EXPECT_FALSE(read["path"][3]["captured"].get<bool>()); // beside /pau/
  EXPECT_EQ(read["path"][0]["runners_up"].size(), 2u);
  const std::string table_text = explain_result(json.dump(), "r.json");
  const std::size_t rows = result.rows.size();
  EXPECT_TRUE(table_text.starts_with(fmt::format("{} sounding phonemes: ", rows - 1)));
  EXPECT_NE(table_text.find(fmt::format("{} of {} joins between chosen nodes as recorded\n",
                                        std::ranges::count(result.rows, true, &PathRow::captured),
                                        rows - 1)),
            std::string::npos);
  for (const PathRow& row : result.rows) {
    EXPECT_NE(table_text.find(t.key(row.node)), std::string::npos);
  }
}

TEST(Synthesize, OutputSamplesEndWithTheTranscript) {
  const MotionTable t = table(4);
  SynthesisInput input = said_again(t, longest_run(t));
  input.fps = 30.0;
  ViterbiSearch search(t, input.weights);
  const SynthesisResult result = synthesize(t, search, input);
  const double end_s = input.transcript.back().end_s;
  const auto frames = static_cast<double>(result.output.coefficients.rows());
  EXPECT_LE((frames - 1.0) / 30.0, end_s + 1e-9);
  EXPECT_GT(frames / 30.0, end_s);
}

} // namespace
} // namespace phonomime
