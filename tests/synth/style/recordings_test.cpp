// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings in four emotions, three of them made from the recorded one by rule: what holds here
// says nothing about real emotions. A sample of them; phonomime_style_table judges all.
#include "db/types/percentile.h"
#include "synth/style/tempo.h"
#include "tests/support/shared_data.h"
#include "tests/synth/style/judged_styles.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace phonomime::test {

namespace {

// 48 sentences, every sixth of them held out.
const JudgedStyles& sample(const std::filesystem::path& shared) {
  static const JudgedStyles judged = [&] {
    const std::filesystem::path folder = shared / "grid_s1_expressive";
    const Corpus corpus = read_corpus(folder);
    std::set<std::string> ids, taken, held_out;
    for (const CorpusSentence& sentence : corpus.sentences) {
      ids.insert(sentence.id);
    }
    for (std::size_t i = 0; const std::string& id : ids) {
      if (i % 3 == 0 && taken.size() < 48) {
        taken.insert(id);
        if (taken.size() % 6 == 0) {
          held_out.insert(id);
        }
      }
      ++i;
    }
    return JudgedStyles::train(
        folder, [&](const CorpusSentence& sentence) { return taken.contains(sentence.id); },
        [&](const CorpusSentence& sentence) { return held_out.contains(sentence.id); }, {});
  }();
  return judged;
}

} // namespace

TEST(StyleRecordings, ComeNearerToWhatWasSpokenThanTheRivals) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const JudgedStyles& judged = sample(shared);
  EXPECT_EQ(judged.spoken.size(), 8U);
  EXPECT_EQ(judged.trained.sentences.size(), 40U);
  const std::vector<PairError> errors = judged.pair_errors();
  ASSERT_EQ(errors.size(), 12U);
  double ours_of_all = 0.0, regression_of_all = 0.0; // sums of squares
  for (const PairError& pair : errors) {
    using Squares = PairError::Squares;
    const double ours = pair.rms(&Squares::ours);
    EXPECT_LT(ours, pair.rms(&Squares::unchanged)) << pair.from << " to " << pair.to;
    EXPECT_LT(ours, pair.rms(&Squares::mean_difference)) << pair.from << " to " << pair.to;
    // Of so few sentences a pair may be a hair farther; trained on all, none is.
    EXPECT_LE(ours, 1.01 * pair.rms(&Squares::regression)) << pair.from << " to " << pair.to;
    ours_of_all += pair.squares.ours;
    regression_of_all += pair.squares.regression;
  }
  EXPECT_LT(ours_of_all, 0.98 * regression_of_all);
}

TEST(StyleRecordings, LipsStillMeetAndMotionStaysSmooth) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const JudgedStyles& judged = sample(shared);
  for (const double intensity : {0.5, 1.0, 1.5}) {
    const LipFigures figures = judged.lips(intensity);
    EXPECT_GT(figures.lips, 100);
    EXPECT_GT(figures.teeth, 20);
    EXPECT_GE(static_cast<double>(figures.closed_after),
              0.99 * static_cast<double>(figures.closed_before));
    EXPECT_GE(figures.inside_after, figures.inside_before);
    EXPECT_EQ(figures.taken_out, 0);
    EXPECT_EQ(figures.left, 0);
    EXPECT_LE(*percentile(figures.changed, 0.99), 1.2 * *percentile(figures.recorded, 0.99));
  }
}

TEST(StyleRecordings, AnUnknownEmotionIsFound) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const JudgedStyles& judged = sample(shared);
  for (const Eigen::Index frames : {10, 30, 75}) {
    const FoundStyles found = judged.find_styles(frames);
    EXPECT_GT(found.windows, 30);
    EXPECT_GE(static_cast<double>(found.right), 0.97 * static_cast<double>(found.windows))
        << frames;
  }
}

TEST(StyleRecordings, TempoIsWhatTheRuleGave) {
  PHONOMIME_NEEDS_SHARED_DATA(shared);
  const TempoModel tempo = learn_tempo(sample(shared).table, {});
  // Times in the alignments of each emotion over those of neutral, the same for every phoneme.
  const std::map<std::string, double> given = {
      {"anger", 0.88}, {"happiness", 0.95}, {"sadness", 1.18}};
  ASSERT_EQ(tempo.emotions.size(), given.size());
  for (const auto& [emotion, ratio] : given) {
    const EmotionTempo& learned = tempo.emotions.at(emotion);
    EXPECT_NEAR(learned.overall, ratio, 0.005) << emotion;
    EXPECT_GT(learned.of_viseme.size(), 8U);
    for (const auto& [viseme, of_viseme] : learned.of_viseme) {
      EXPECT_NEAR(of_viseme, ratio, 0.02) << emotion << " " << viseme; // in whole frames
    }
  }
}

} // namespace phonomime::test
