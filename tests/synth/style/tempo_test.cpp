// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/tempo.h"

#include "tests/support/expect_error.h"
#include "tests/synth/style/made_table.h"

#include <gtest/gtest.h>

namespace phonomime::test {

namespace {

TimedPhoneme row(const std::string& phoneme, double start_s, double end_s) {
  return {{phoneme, phoneme, Visibility::intermediate}, start_s, end_s};
}

TempoModel made_tempo() {
  return {.neutral = "neutral",
          .emotions = {{"anger", {.overall = 0.8, .of_viseme = {{"a", 0.6}}, .pause = 0.5}},
                       {"joy", {.overall = 0.2, .of_viseme = {}}}}};
}

} // namespace

TEST(Tempo, IsTheRatioOfDurationsDrawnToTheOverallOne) {
  MadeTable made;
  for (int i = 0; i < 40; ++i) { // a: 10 frames to 5, b: 30 to 45; c is said in neutral alone
    const std::string id = "s" + std::to_string(i);
    made.say(id, "neutral", {{"a", 8 + 4 * (i % 2)}, {"b", 30}, {"c", 7}});
    made.say(id, "anger", {{"a", 5}, {"b", 45}});
  }
  const TempoModel tempo = learn_tempo(made.table, {.styles = {"neutral", "anger"}});
  ASSERT_EQ(tempo.emotions.size(), 1U);
  const EmotionTempo& anger = tempo.emotions.at("anger");
  EXPECT_NEAR(anger.overall, 50.0 / 40.0, 1e-12);
  // 40 phonemes of their own against 20 of the overall ratio: of 20 frames, the mean of all, where
  // their own are shorter.
  EXPECT_NEAR(anger.of_viseme.at("a"), (40 * 5 + 20 * 20 * 1.25) / (40 * 10 + 20 * 20), 1e-12);
  EXPECT_NEAR(anger.of_viseme.at("b"), (40 * 1.5 + 20 * 1.25) / 60.0, 1e-12);
  EXPECT_FALSE(anger.of_viseme.contains("c"));
  EXPECT_EQ(anger.pause, anger.overall); // nobody makes one
}

TEST(Tempo, PausesHaveTheirOwnRatio) {
  MadeTable made;
  for (int i = 0; i < 10; ++i) { // 8 frames of pause to 24; silence at the ends is none
    const std::string id = "s" + std::to_string(i);
    made.say(id, "neutral", {{"pau", 50}, {"a", 10}, {"pau", 8}, {"b", 10}, {"c", 10}, {"pau", 9}});
    made.say(id, "anger", {{"pau", 10}, {"a", 5}, {"pau", 24}, {"b", 5}, {"c", 5}, {"pau", 90}});
    // A pause that the other reading does not make, and a phoneme that it leaves out, are none.
    const std::string other = "t" + std::to_string(i);
    made.say(other, "neutral", {{"a", 10}, {"pau", 40}, {"b", 10}, {"c", 10}, {"a", 10}});
    made.say(other, "anger", {{"a", 5}, {"b", 5}, {"pau", 3}, {"a", 5}});
  }
  const EmotionTempo anger =
      learn_tempo(made.table, {.styles = {"neutral", "anger"}}).emotions.at("anger");
  EXPECT_NEAR(anger.overall, 0.5, 1e-12);
  EXPECT_NEAR(anger.pause, (10 * 24 + 20 * 10 * 0.5) / (10 * 8 + 20 * 10), 1e-12);
}

TEST(Tempo, RetimesPhonemesAndPausesAndLeavesTheEnds) {
  const std::vector<TimedPhoneme> rows = {
      row("pau", 0.0, 0.5), row("a", 0.5, 0.7), row("c", 0.7, 0.8),  row("a", 0.8, 1.0),
      row("pau", 1.0, 1.4), row("a", 1.4, 1.5), row("pau", 1.5, 2.4)};
  const std::vector<EmotionMixture> emotions = {
      {{"anger", 1.0}}, {{"anger", 1.0}},   {{"anger", 0.5}}, {{"anger", 0.0}},
      {{"anger", 1.5}}, {{"neutral", 1.5}}, {{"anger", 1.5}}};
  const std::vector<TimedPhoneme> found = retime(rows, emotions, made_tempo());
  const double durations_s[] = {0.5, 0.2 * 0.6, 0.1 * 0.9, 0.2, 0.4 * 0.25, 0.1, 0.9};
  double start_s = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(found[i].phoneme, rows[i].phoneme);
    EXPECT_NEAR(found[i].start_s, start_s, 1e-12);
    EXPECT_NEAR(found[i].end_s, start_s + durations_s[i], 1e-12);
    start_s = found[i].end_s;
  }
  EXPECT_NEAR(retimed_at(rows, found, -0.1), -0.1, 1e-12);
  EXPECT_NEAR(retimed_at(rows, found, 0.6), 0.56, 1e-12);
  EXPECT_NEAR(retimed_at(rows, found, 0.7), 0.62, 1e-12);
  EXPECT_NEAR(retimed_at(rows, found, 2.9), found.back().end_s + 0.5, 1e-12);
}

TEST(Tempo, OfAMixtureIsTheSumOfItsParts) {
  const std::vector<TimedPhoneme> rows = {row("a", 0.0, 1.0), row("c", 1.0, 2.0)};
  const std::vector<EmotionMixture> mixtures(2, parse_emotion_mixture("anger:0.6+joy:0.3", ""));
  const std::vector<TimedPhoneme> found = retime(rows, mixtures, made_tempo());
  EXPECT_NEAR(found[0].end_s, 1.0 - 0.6 * 0.4 - 0.3 * 0.8, 1e-12);
  EXPECT_NEAR(found[1].end_s - found[1].start_s, 1.0 - 0.6 * 0.2 - 0.3 * 0.8, 1e-12);
}

TEST(Tempo, NeverTurnsTimeRound) {
  const std::vector<TimedPhoneme> rows = {row("a", 0.0, 1.0)};
  const std::vector<EmotionMixture> far = {{{"joy", 1.5}}};
  EXPECT_NEAR(retime(rows, far, made_tempo())[0].end_s, 0.1, 1e-12);
}

TEST(Tempo, RefusesAnEmotionThatItDoesNotKnow) {
  const std::vector<TimedPhoneme> rows = {row("a", 0.0, 1.0)};
  const std::vector<EmotionMixture> bored = {{{"boredom", 1.0}}};
  expect_error([&] { retime(rows, bored, made_tempo()); },
               "the tempo of the emotion boredom was not learned (expected neutral, anger, joy, "
               "got boredom)");
  EXPECT_THROW(retime(rows, {}, made_tempo()), InternalError);
}

} // namespace phonomime::test
