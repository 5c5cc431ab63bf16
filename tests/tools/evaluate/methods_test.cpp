// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/method.h"

#include "db/types/errors.h"
#include "db/types/row_frames.h"
#include "synth/pipeline/synthesize.h"
#include "tests/tools/evaluate/small_table.h"
#include "tools/evaluate/anchors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace phonomime {
namespace {

struct Setting {
  MotionTable table;
  CostWeights weights;
  ImportedSentence sentence;
};

Setting make_setting(std::uint64_t seed, int emotions = 1) {
  test::Draw draw(seed);
  Setting setting{
      .table = test::contextual_table(draw, 30, emotions), .weights = {}, .sentence = {}};
  setting.weights = test::random_weights(draw);
  setting.sentence = test::random_sentence(setting.table, 12, draw);
  return setting;
}

MethodAnswer say(const Setting& setting, const std::string& name, bool with_recording = false) {
  const std::vector<MethodEntry> found = find_methods(std::vector{name});
  const MethodContext context{.table = setting.table,
                              .weights = setting.weights,
                              .paper_weights = setting.weights,
                              .concat = {}};
  return found.front()
      .make(context, {})
      ->say(test::request_for(setting.sentence, with_recording), 0, {});
}

FrameMatrixD coefficients(const Setting& setting, const FrameMatrix& channels) {
  return (channels.cast<double>().rowwise() - setting.table.pca.mean.transpose()) *
         setting.table.pca.basis;
}

TEST(Methods, AreFoundByTheirNamesInTheOrderAsked) {
  EXPECT_EQ(find_methods({}).size(), method_table().size());
  const std::vector<MethodEntry> found = find_methods(std::vector<std::string>{"oracle", "paper"});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "oracle");
  EXPECT_EQ(found[1].name, "paper");
  EXPECT_THROW(find_methods(std::vector<std::string>{"papr"}), UsageError);
  EXPECT_THROW(find_methods(std::vector<std::string>{"paper", "paper"}), UsageError);
}

TEST(Methods, OnlyTheOracleSeesTheRecording) {
  std::set<std::string_view> seeing;
  for (const MethodEntry& method : method_table()) {
    if (method.sees_recording) {
      seeing.insert(method.name);
    }
  }
  EXPECT_EQ(seeing, std::set<std::string_view>{"oracle"});
  EXPECT_THROW(say(make_setting(1), "oracle"), InternalError);
}

TEST(Methods, AnswerWithAsManyFramesAsTheRecordingHas) {
  for (const MethodEntry& method : method_table()) {
    const Setting setting = make_setting(2);
    const MethodAnswer answer = say(setting, std::string(method.name), method.sees_recording);
    EXPECT_EQ(answer.sentence.channels.rows(), setting.sentence.channels.rows()) << method.name;
    EXPECT_EQ(answer.sentence.channels.cols(), setting.sentence.channels.cols()) << method.name;
    EXPECT_TRUE(answer.sentence.channels.allFinite()) << method.name;
  }
}

TEST(Methods, RefuseAnEmotionThatWasNeverRecorded) {
  for (const MethodEntry& method : method_table()) {
    Setting setting = make_setting(3);
    setting.sentence.emotion = "awe";
    if (!method.sees_recording) {
      EXPECT_THROW(say(setting, std::string(method.name)), InputError) << method.name;
    }
  }
}

TEST(Paper, IsWhatTheRecipeMakes) {
  const Setting setting = make_setting(4);
  const MethodAnswer answer = say(setting, "paper");
  ViterbiSearch search(setting.table, setting.weights);
  SynthesisInput input;
  input.transcript = setting.sentence.rows;
  input.emotions.assign(input.transcript.size(), {.emotion = setting.sentence.emotion});
  input.weights = setting.weights;
  const SynthesisResult result = synthesize(setting.table, search, input);
  const FrameMatrixD expected = result.motion.coefficients.topRows(answer.sentence.channels.rows());
  EXPECT_LT((coefficients(setting, answer.sentence.channels) - expected).cwiseAbs().maxCoeff(),
            1e-4);
  std::size_t joins = 0;
  const std::vector<FrameRange> frames = row_frames(setting.sentence.rows, setting.table.rate_hz);
  for (std::size_t i = 1; i < result.rows.size(); ++i) {
    if (!result.rows[i].phoneme.is_silence() && !result.rows[i - 1].phoneme.is_silence()) {
      ASSERT_LT(joins, answer.sentence.joins.size());
      EXPECT_EQ(answer.sentence.joins[joins].frame, frames[i].first);
      EXPECT_EQ(answer.sentence.joins[joins].captured, result.rows[i].captured);
      ++joins;
    }
  }
  EXPECT_EQ(joins, answer.sentence.joins.size());
}

TEST(MeanPose, IsTheMeanOfTheFramesWithinTheSpeechOfTheEmotion) {
  const Setting setting = make_setting(5, 3);
  const MethodAnswer answer = say(setting, "mean_pose");
  std::map<std::int32_t, std::pair<std::int64_t, std::int64_t>> speech; // by sentence
  for (const MotionNode& node : setting.table.nodes) {
    if (node.emotion == 0) {
      const auto [place, is_new] = speech.try_emplace(node.sentence, node.first_frame, 0);
      place->second.second = node.first_frame + node.frame_count;
    }
  }
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(setting.table.coefficients.cols());
  double count = 0.0;
  for (const auto& [sentence, range] : speech) {
    for (std::int64_t frame = range.first; frame < range.second; ++frame, ++count) {
      sum += setting.table.coefficients.row(frame).cast<double>();
    }
  }
  const FrameMatrixD said = coefficients(setting, answer.sentence.channels);
  EXPECT_LT((said.rowwise() - sum / count).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(VisemeKeyframes, PassThroughTheVisemesMeanPosesInStraightLines) {
  const Setting setting = make_setting(6);
  const FrameMatrixD said =
      coefficients(setting, say(setting, "viseme_keyframes").sentence.channels);
  // Mean of the middles of a viseme's nodes, an even number of frames having two.
  std::map<std::int32_t, std::pair<Eigen::RowVectorXd, int>> poses;
  for (const MotionNode& node : setting.table.nodes) {
    const std::int64_t left = node.first_frame + (node.frame_count - 1) / 2;
    const std::int64_t right = node.first_frame + node.frame_count / 2;
    auto& [sum, count] =
        poses.try_emplace(node.viseme, Eigen::RowVectorXd::Zero(said.cols()), 0).first->second;
    sum += 0.5 * (setting.table.coefficients.row(left) + setting.table.coefficients.row(right))
                     .cast<double>();
    ++count;
  }
  const std::vector<FrameRange> frames = row_frames(setting.sentence.rows, setting.table.rate_hz);
  int keys_seen = 0, lines_seen = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const TimedPhoneme& row = setting.sentence.rows[i];
    if (row.is_silence()) {
      continue;
    }
    const auto& [sum, count] = poses.at(*setting.table.find_viseme(row.phoneme.viseme));
    if (frames[i].count % 2 == 1) {
      const Eigen::Index middle = frames[i].first + frames[i].count / 2;
      EXPECT_LT((said.row(middle) - sum / count).cwiseAbs().maxCoeff(), 1e-4) << i;
      ++keys_seen;
    }
    // Between this middle and the next there is no bend.
    if (i + 1 < frames.size() && !setting.sentence.rows[i + 1].is_silence()) {
      const Eigen::Index from = frames[i].first + frames[i].count / 2;
      const Eigen::Index to = frames[i + 1].first + (frames[i + 1].count - 1) / 2;
      for (Eigen::Index k = from + 1; k < to; ++k, ++lines_seen) {
        EXPECT_LT((said.row(k - 1) - 2.0 * said.row(k) + said.row(k + 1)).cwiseAbs().maxCoeff(),
                  1e-4);
      }
    }
  }
  EXPECT_GT(keys_seen, 2);
  EXPECT_GT(lines_seen, 5);
}

// A table of nodes of one sentence each, whose only coefficient is its index throughout.
struct Candidate {
  std::int32_t phoneme, before, after, frames, emotion;
};

MotionTable table_of(const std::vector<Candidate>& candidates) {
  test::Draw draw(1);
  test::TableShape shape;
  shape.sentences = 1;
  shape.emotions = 2;
  shape.dimensions = 1;
  MotionTable table = test::random_table(shape, draw);
  table.nodes.clear();
  table.sentences.clear();
  std::vector<float> values;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    table.sentences.push_back({"s", table.emotions[0], "u" + std::to_string(i), ""});
    MotionNode node;
    node.phoneme = candidate.phoneme;
    node.viseme = *table.find_viseme(table.phonemes[static_cast<std::size_t>(node.phoneme)].viseme);
    node.emotion = candidate.emotion;
    node.sentence = static_cast<std::int32_t>(i);
    node.previous_phoneme = candidate.before;
    node.next_phoneme = candidate.after;
    node.first_frame = static_cast<std::int64_t>(values.size());
    node.frame_count = candidate.frames;
    values.insert(values.end(), static_cast<std::size_t>(candidate.frames), static_cast<float>(i));
    table.nodes.push_back(node);
  }
  table.coefficients =
      Eigen::Map<const FrameMatrix>(values.data(), static_cast<Eigen::Index>(values.size()), 1);
  return table;
}

// Which candidate speaks phoneme 2 between 1 and 3 for six frames. Phonemes 1 and 4, 2 and 5, 3 and
// 6 share their viseme.
long chosen(const std::vector<Candidate>& candidates) {
  Setting setting{.table = table_of(candidates), .weights = {}, .sentence = {}};
  setting.sentence.emotion = setting.table.emotions[0];
  int frame = 0;
  for (const std::size_t phoneme : {1u, 2u, 3u}) {
    setting.sentence.rows.push_back({.phoneme = setting.table.phonemes[phoneme],
                                     .start_s = frame / 100.0,
                                     .end_s = (frame + 6) / 100.0});
    frame += 6;
  }
  setting.sentence.channels.setZero(frame, setting.table.layout.channel_count());
  const MethodContext context{
      .table = setting.table, .weights = {}, .concat = {.smoothing_half_window = 0}};
  const MethodAnswer answer = find_methods(std::vector<std::string>{"triphone"})
                                  .front()
                                  .make(context, {})
                                  ->say(test::request_for(setting.sentence), 0, {});
  return std::lround(coefficients(setting, answer.sentence.channels)(8, 0));
}

TEST(Triphone, TakesThePhonemeThenTheEmotionThenTheContextThenTheDuration) {
  const Candidate other_viseme = {3, 1, 3, 6, 0};
  const Candidate same_viseme = {5, 1, 3, 6, 0};
  const Candidate other_emotion = {2, 1, 3, 6, 1};
  const Candidate no_context = {2, 0, 0, 6, 0};
  const Candidate half_context = {2, 1, 0, 6, 0};
  const Candidate similar_context = {2, 4, 3, 60, 0};
  const Candidate too_long = {2, 1, 3, 13, 0};
  const Candidate shorter = {2, 1, 3, 3, 0};
  const Candidate near = {2, 1, 3, 7, 0};
  EXPECT_EQ(chosen({other_viseme, same_viseme}), 1);
  EXPECT_EQ(chosen({same_viseme, other_emotion}), 1);
  EXPECT_EQ(chosen({other_emotion, no_context}), 1);
  EXPECT_EQ(chosen({no_context, half_context}), 1);
  EXPECT_EQ(chosen({half_context, similar_context}), 1);
  EXPECT_EQ(chosen({similar_context, too_long}), 1);
  EXPECT_EQ(chosen({too_long, shorter}), 1); // 6 : 3 is nearer than 13 : 6
  EXPECT_EQ(chosen({shorter, near}), 1);
  EXPECT_EQ(chosen({near, shorter, too_long}), 0);
  EXPECT_EQ(chosen({near, near}), 0);
}

TEST(Oracle, SpeaksARecordingThatTheTableHoldsWordForWord) {
  Setting setting = make_setting(8);
  const MotionTable& table = setting.table;
  // Nodes of one sentence after the other, as a recording.
  setting.sentence.rows.clear();
  FrameMatrixD recorded(0, table.coefficients.cols());
  int frame = 0;
  for (NodeIndex i = 0; i < 6; ++i) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(i)];
    const int end = frame + node.frame_count;
    setting.sentence.rows.push_back(
        {.phoneme = table.phonemes[1], .start_s = frame / 100.0, .end_s = end / 100.0});
    recorded.conservativeResize(end, Eigen::NoChange);
    recorded.bottomRows(node.frame_count) = table.node_frames(i).cast<double>();
    frame = end;
  }
  setting.sentence.channels =
      ((recorded * table.pca.basis.transpose()).rowwise() + table.pca.mean.transpose())
          .cast<float>();
  MethodContext context{.table = table, .weights = setting.weights, .concat = {}};
  context.concat.smoothing_half_window = 0;
  const std::vector<MethodEntry> found = find_methods(std::vector<std::string>{"oracle"});
  const MethodAnswer answer =
      found.front().make(context, {})->say(test::request_for(setting.sentence, true), 0, {});
  EXPECT_LT((answer.sentence.channels - setting.sentence.channels).cwiseAbs().maxCoeff(), 1e-4);
}

} // namespace
} // namespace phonomime
