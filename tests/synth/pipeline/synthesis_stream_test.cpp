// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/synthesis_stream.h"

#include "db/types/errors.h"
#include "synth/concat/append_frames.h"
#include "synth/pipeline/synthesize.h"
#include "tests/synth/search/random_tables.h"

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

const CostWeights kWeights{1.0, 0.2, 20.0, 0.4, 10.0, 10.0, 500.0};

// Chooses, a number of steps late, the nodes that it was told to.
class ToldChooser : public NodeChooser {
public:
  ToldChooser(std::vector<NodeIndex> nodes, std::size_t late)
      : nodes_(nodes.begin(), nodes.end()), late_(late) {}

  std::vector<NodeIndex> push(const SearchStep& step) override {
    steps.push_back(step);
    return ++open_ > late_ ? take(1) : std::vector<NodeIndex>();
  }
  std::vector<NodeIndex> finish() override { return take(open_); }

  std::vector<SearchStep> steps;

private:
  std::vector<NodeIndex> take(std::size_t count) {
    const auto end = nodes_.begin() + static_cast<std::ptrdiff_t>(count);
    const std::vector<NodeIndex> taken(nodes_.begin(), end);
    nodes_.erase(nodes_.begin(), end);
    open_ -= count;
    return taken;
  }

  std::deque<NodeIndex> nodes_;
  std::size_t late_;
  std::size_t open_ = 0;
};

MotionTable small_table(test::Draw& draw) {
  return test::random_table({.sentences = 10, .longest_sentence = 6}, draw);
}

SynthesisInput random_input(const MotionTable& table, test::Draw& draw, int length) {
  SynthesisInput input;
  double end_s = 0.0;
  for (int i = 0; i < length; ++i) {
    const bool silence = draw.chance(0.3);
    const int phoneme = silence ? 0 : 1 + draw.below(static_cast<int>(table.phonemes.size()) - 1);
    const double start_s = end_s;
    end_s += silence ? 0.05 + 0.3 * draw.unit() : 0.04 + 0.1 * draw.unit();
    input.transcript.push_back({table.phonemes[static_cast<std::size_t>(phoneme)], start_s, end_s});
    input.emotions.push_back({table.emotions[static_cast<std::size_t>(
        draw.below(static_cast<int>(table.emotions.size())))]});
    if (draw.chance(0.1)) {
      const NodeIndex node = draw.below(table.node_count());
      input.constraints.push_back(
          {.kind = draw.chance(0.5) ? ConstraintKind::use : ConstraintKind::avoid,
           .index = draw.chance(0.5) ? std::optional<long>(i) : std::nullopt,
           .keys = {table.key(node)},
           .where = "constraints:" + std::to_string(i)});
      if (!input.constraints.back().index) {
        input.constraints.back().time_s = 0.5 * (start_s + end_s);
      }
    }
  }
  input.weights = kWeights;
  return input;
}

std::vector<NodeIndex> nodes_of(const SynthesisResult& result) {
  std::vector<NodeIndex> nodes;
  for (const PathRow& row : result.rows) {
    if (row.node != kNoNode) {
      nodes.push_back(row.node);
    }
  }
  return nodes;
}

void expect_same_step(const SearchStep& got, const SearchStep& expected) {
  EXPECT_EQ(got.phoneme, expected.phoneme);
  EXPECT_EQ(got.viseme, expected.viseme);
  EXPECT_EQ(got.emotion, expected.emotion);
  EXPECT_EQ(got.is_silence, expected.is_silence);
  EXPECT_EQ(got.allowed, expected.allowed);
  EXPECT_EQ(got.avoided, expected.avoided);
}

// The search is asked the same, and of the same nodes come the same frames, however late.
TEST(SynthesisStream, DoesWhatSynthesizeDoes) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Draw draw(seed);
    const MotionTable table = small_table(draw);
    const SynthesisInput input = random_input(table, draw, 1 + draw.below(25));
    ViterbiSearch search(table, input.weights);
    const SynthesisResult expected = synthesize(table, search, input);
    const TranscriptSteps steps =
        make_transcript_steps(table, input.transcript, input.emotions, input.constraints);
    for (const std::size_t late : {0u, 3u, 100u}) {
      ToldChooser chooser(nodes_of(expected), late);
      SynthesisStream stream(table, chooser,
                             {.constraints = input.constraints, .concat = input.concat});
      FrameMatrixD frames(0, table.coefficients.cols());
      for (std::size_t i = 0; i < input.transcript.size(); ++i) {
        append_frames(frames, stream.push(input.transcript[i], input.emotions[i]));
      }
      append_frames(frames, stream.finish());
      ASSERT_EQ(frames.rows(), expected.output.coefficients.rows()) << seed;
      EXPECT_TRUE(frames == expected.output.coefficients) << seed;
      ASSERT_EQ(chooser.steps.size(), steps.steps.size()) << seed;
      for (std::size_t i = 0; i < steps.steps.size(); ++i) {
        expect_same_step(chooser.steps[i], steps.steps[i]);
      }
      std::vector<std::string> warnings = stream.take_warnings();
      std::vector<std::string> offline = expected.warnings;
      std::ranges::sort(warnings);
      std::ranges::sort(offline);
      EXPECT_EQ(warnings, offline) << seed;
    }
  }
}

TEST(SynthesisStream, AConstraintIsMetOrRefused) {
  test::Draw draw(7);
  const MotionTable table = small_table(draw);
  const auto refusal = [&](const NodeConstraint& constraint) -> std::string {
    try {
      ToldChooser chooser({0, 1, 2}, 0);
      SynthesisStream stream(table, chooser, {.constraints = {constraint}, .concat = {}});
      for (int i = 0; i < 3; ++i) {
        stream.push({table.phonemes[1], 0.1 * i, 0.1 * (i + 1)}, {table.emotions[0]});
      }
      stream.finish();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string key = table.key(0);
  EXPECT_EQ(refusal({.index = 2, .keys = {key}, .where = "c:1"}), "");
  EXPECT_EQ(refusal({.time_s = 0.25, .keys = {key}, .where = "c:1"}), "");
  EXPECT_NE(refusal({.index = 3, .keys = {key}, .where = "c:1"}).find("c:1"), std::string::npos);
  EXPECT_NE(refusal({.time_s = 0.31, .keys = {key}, .where = "c:1"}).find("c:1"),
            std::string::npos);
  EXPECT_NE(refusal({.index = 2, .keys = {"nobody#1"}, .where = "c:1"}).find("nobody#1"),
            std::string::npos);
}

TEST(SynthesisStream, SilenceAloneRests) {
  test::Draw draw(8);
  const MotionTable table = small_table(draw);
  ToldChooser chooser({}, 0);
  SynthesisStream stream(table, chooser, {});
  EXPECT_THROW(stream.finish(), InputError);
  FrameMatrixD frames = stream.push({table.phonemes[0], 0.0, 2.0}, {table.emotions[0]});
  append_frames(frames, stream.finish());
  EXPECT_EQ(frames.rows(), 61);
  EXPECT_EQ(stream.step_count(), 0u);
  EXPECT_TRUE(chooser.steps.empty());
}

} // namespace
} // namespace phonomime
