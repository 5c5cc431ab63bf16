// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/aggregate.h"

#include "db/types/errors.h"
#include "tests/support/expect_error.h"
#include "tests/tools/evaluate/made_evaluation.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

using enum Measure;

// A sentence of /aa/ whose chin is off by so much.
SentenceMeasures off_by(double error_mm, int frames, const std::string& id) {
  ImportedSentence sentence = one_phoneme(frames);
  sentence.id = id;
  FrameMatrix synthesised = sentence.channels;
  synthesised.col(3 * chin).array() += static_cast<float>(error_mm);
  return measure_sentence(made_setup(), sentence, synthesised, {});
}

TEST(Aggregate, MainFiguresAreMeansOfSentencesAndPooledOnesOfFrames) {
  Evaluation evaluation;
  evaluation.layout = made_layout();
  evaluation.methods = {
      {.id = "one",
       .sentences = {off_by(4.0, 90, "c"), off_by(2.0, 30, "a"), off_by(0.0, 30, "b")}}};
  aggregate(evaluation);
  const MethodTables& tables = evaluation.tables.at(0);
  const Summary& error = tables[squared_error];
  // Sentences 2, 0.5 and 0; frames 90 of 2, 30 of 0.5, 30 of 0.
  EXPECT_NEAR(*error.mean, 2.5 / 3.0, 1e-6);
  EXPECT_NEAR(*error.pooled, (90.0 * 2.0 + 30.0 * 0.5) / 150.0, 1e-6);
  const double mean = 2.5 / 3.0;
  const double variance = (std::pow(2.0 - mean, 2) + std::pow(0.5 - mean, 2) + mean * mean) / 2.0;
  EXPECT_NEAR(*error.standard_error, std::sqrt(variance / 3.0), 1e-6);
  EXPECT_EQ(error.sentences, 3);
  EXPECT_NEAR(tables.total_error, 2.5, 1e-5); // E12
  EXPECT_NEAR(*tables.marker_rmse.at(chin), std::sqrt((90.0 * 16.0 + 30.0 * 4.0) / 150.0), 1e-5);
  EXPECT_EQ(tables.marker_rmse.at(brow), 0.0);
  EXPECT_NEAR(*tables.region_rmse.at(static_cast<std::size_t>(Region::jaw)),
              *tables.marker_rmse.at(chin), 1e-12);
  EXPECT_FALSE(tables.region_rmse.at(static_cast<std::size_t>(Region::cheeks)));
  EXPECT_EQ(evaluation.methods[0].sentences[0].key, "s1/neutral/a");
  EXPECT_FALSE(tables[closure_recall].mean); // no /p b m/ anywhere
  EXPECT_EQ(tables[closure_recall].sentences, 0);
}

TEST(Aggregate, PartsAddUpToTheWhole) {
  Evaluation evaluation = made_evaluation(11, {{"main", 0.8}});
  aggregate(evaluation);
  const MethodTables& tables = evaluation.tables.at(0);
  const auto at = static_cast<std::size_t>(squared_error);
  double emotions = 0.0, folds = 0.0, phonemes = 0.0;
  std::int64_t frames = 0;
  for (const auto& [emotion, summaries] : tables.by_emotion) {
    emotions += *summaries[at].mean * static_cast<double>(summaries[at].sentences);
  }
  for (const auto& [fold, summaries] : tables.by_fold) {
    folds += *summaries[at].mean * static_cast<double>(summaries[at].sentences);
  }
  for (const auto& [phoneme, values] : tables.by_phoneme) {
    phonemes += *values[squared_error] * static_cast<double>(tables.phoneme_frames.at(phoneme));
    frames += tables.phoneme_frames.at(phoneme);
  }
  EXPECT_EQ(tables.by_emotion.size(), 2u);
  EXPECT_EQ(tables.by_fold.size(), 5u);
  EXPECT_NEAR(emotions, 11.0 * *tables[squared_error].mean, 1e-9);
  EXPECT_NEAR(folds, 11.0 * *tables[squared_error].mean, 1e-9);
  // All frames within the speech but those of the inner pause are a phoneme's.
  double whole = 0.0;
  for (const SentenceMeasures& sentence : evaluation.methods[0].sentences) {
    for (const double sum : sentence.sums.group_error_sq) {
      whole += sum / static_cast<double>(group_count);
    }
    for (std::int64_t k = 36; k < 41; ++k) {
      whole -= sentence.frame_error[static_cast<std::size_t>(k)];
    }
    frames -= sentence.sums.frames - 5;
  }
  EXPECT_EQ(frames, 0);
  EXPECT_NEAR(phonemes, whole, 1e-3 * whole);
}

TEST(Aggregate, ContactsAreJudgedByTheRecordings) {
  Evaluation evaluation = made_evaluation(24, {{"exact", 0.0}, {"open", 0.0}});
  for (SentenceMeasures& sentence : evaluation.methods[1].sentences) {
    for (LipEvent& event : sentence.lip_events) {
      event.synthesised_aperture_mm += 50.0;
    }
  }
  aggregate(evaluation);
  ASSERT_EQ(evaluation.contact_ranges.size(), 2u); // /f/ and /v/
  for (const Measure measure : {contact_share, contact_share_recorded}) {
    // 24 rows: the 10th percentile lies between the third and the fourth.
    EXPECT_NEAR(*evaluation.tables[0][measure].pooled, 18.0 / 24.0, 1e-12);
  }
  EXPECT_EQ(evaluation.tables[1][contact_share].pooled, 0.0);
  EXPECT_NEAR(*evaluation.tables[1].by_phoneme.at("f")[contact_share_recorded], 18.0 / 24.0, 1e-12);
  aggregate(evaluation); // once more changes nothing
  EXPECT_NEAR(*evaluation.tables[0][contact_share].pooled, 18.0 / 24.0, 1e-12);
  EXPECT_EQ(evaluation.methods[0].sentences[0].sums.contact.count, 2);
  // Ranges of one's own replace the judgement; a phoneme without one is not judged.
  judge_contacts(evaluation.methods[0].sentences, {{"f", {-100.0, 100.0, 24}}});
  EXPECT_EQ(
      summarise(evaluation.methods[0].sentences)[static_cast<std::size_t>(contact_share)].mean,
      1.0);
  EXPECT_EQ(evaluation.methods[0].sentences[0].sums.contact.count, 1);
}

TEST(Aggregate, RefusesNothingAndMethodsOfOtherSentences) {
  Evaluation none;
  none.run.corpus = "empty";
  expect_error([&] { aggregate(none); }, "empty: there is no sentence to evaluate");
  Evaluation evaluation = made_evaluation(4, {{"a", 1.0}, {"b", 1.0}});
  evaluation.methods[1].sentences.pop_back();
  evaluation.methods[1].folds.pop_back();
  EXPECT_THROW(aggregate(evaluation), InternalError);
}

TEST(Showcase, KeepsTheWorstAndALotWhateverTheOrder) {
  const auto offered = [](bool backwards) {
    Showcase showcase("main", 3, 2);
    for (int i = 0; i < 20; ++i) {
      const int seed = backwards ? 19 - i : i;
      showcase.offer(made_setup(), made_recording(seed), {made_synthesis({"main", 1.0}, seed)},
                     seed == 7 ? std::nullopt : std::optional<double>(seed * 7 % 20));
    }
    return showcase.shown();
  };
  const std::vector<ShownSentence> shown = offered(false);
  ASSERT_GE(shown.size(), 3u);
  ASSERT_LE(shown.size(), 5u);
  EXPECT_EQ(shown[0].key, "s1/anger/made17"); // 17 * 7 % 20 = 19, 14 -> 18, 11 -> 17
  EXPECT_EQ(shown[1].key, "s1/neutral/made14");
  EXPECT_EQ(shown[2].key, "s1/anger/made11");
  EXPECT_EQ(shown[0].error, 19.0);
  EXPECT_TRUE(shown[2].worst);
  for (std::size_t i = 3; i < shown.size(); ++i) {
    EXPECT_FALSE(shown[i].worst);
  }
  EXPECT_EQ(shown[0].recorded, made_recording(17).channels);
  EXPECT_EQ(shown[0].methods.at(0).channels, made_synthesis({"main", 1.0}, 17).channels);
  EXPECT_TRUE(
      std::ranges::equal(shown, offered(true), {}, &ShownSentence::key, &ShownSentence::key));
}

} // namespace
} // namespace phonomime::test
