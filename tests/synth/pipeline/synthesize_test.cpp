// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/json_file.h"
#include "synth/pipeline/explain.h"
#include "synth/pipeline/result_json.h"
#include "synth/pipeline/synthesize.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>
#include <iterator>

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

// Words that were not recorded in this order.
SynthesisInput said_anew(const MotionTable& t, std::uint64_t seed, int length) {
  test::Draw draw(seed);
  std::vector<NodeIndex> nodes;
  for (int i = 0; i < length; ++i) {
    nodes.push_back(draw.below(t.node_count()));
  }
  SynthesisInput input = said_again(t, nodes);
  input.emotions.assign(nodes.size(), {.emotion = t.emotions[0]});
  return input;
}

std::vector<NodeIndex> nodes_of(const SynthesisResult& result) {
  std::vector<NodeIndex> nodes;
  std::ranges::transform(result.rows, std::back_inserter(nodes), &PathRow::node);
  return nodes;
}

TEST(Synthesize, AUseHoldsInEveryBlendedPath) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const MotionTable t = table(seed);
    SynthesisInput input = said_anew(t, seed, 8);
    input.constraints = {{.index = 3, .keys = {t.key(5)}, .where = "c:1"}};
    input.blend = 4;
    ViterbiSearch search(t, input.weights);
    const SynthesisResult result = synthesize(t, search, input);
    ASSERT_EQ(result.blended.size(), 3u);
    double weight = result.weight + result.expected_weight;
    for (const BlendedPath& path : result.blended) {
      EXPECT_EQ(path.nodes[3], 5);
      EXPECT_GE(path.cost, result.cost);
      weight += path.weight;
    }
    EXPECT_NEAR(weight, 1.0, 1e-12);
  }
}

TEST(Synthesize, ABlendIsTheMeanOfItsPathsMotions) {
  const MotionTable t = table(3);
  SynthesisInput input = said_anew(t, 3, 9);
  input.blend = 3;
  input.concat.blend.liveliness = 0.0;
  ViterbiSearch search(t, input.weights);
  const SynthesisResult result = synthesize(t, search, input);
  ASSERT_EQ(result.blended.size(), 2u);
  EXPECT_EQ(result.expected_weight, 0.0); // the paper's cost expects nothing
  std::vector<std::vector<NodeIndex>> paths = {nodes_of(result)};
  for (const BlendedPath& path : result.blended) {
    paths.push_back(path.nodes);
  }
  FrameMatrixD mean =
      FrameMatrixD::Zero(result.motion.coefficients.rows(), result.motion.coefficients.cols());
  for (const std::vector<NodeIndex>& nodes : paths) {
    std::vector<ConcatStep> steps;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const NodeIndex before = t.nodes[static_cast<std::size_t>(nodes[i])].predecessor;
      steps.push_back({.start_s = input.transcript[i].start_s,
                       .end_s = input.transcript[i].end_s,
                       .node = nodes[i],
                       .captured = i > 0 && before == nodes[i - 1]});
    }
    mean += concatenate(t, steps, input.concat).coefficients / 3.0;
  }
  EXPECT_LT((result.motion.coefficients - mean).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Synthesize, ARecordingIsNotBlended) {
  const MotionTable t = table(1);
  const std::vector<NodeIndex> run = longest_run(t);
  SynthesisInput input = said_again(t, run);
  input.blend = 8;
  input.weights.context = 1.0;
  input.weights.duration = 0.3;
  ViterbiSearch search(t, input.weights);
  const SynthesisResult result = synthesize(t, search, input);
  EXPECT_EQ(nodes_of(result), run);
  EXPECT_TRUE(result.blended.empty());
  EXPECT_EQ(result.weight, 1.0);
  const FrameMatrixD first = t.node_frames(run[0]).cast<double>();
  EXPECT_EQ(result.output.coefficients.topRows(first.rows()), first);
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
