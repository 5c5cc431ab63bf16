// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "synth/pipeline/transcript_steps.h"
#include "tests/support/expect_error.h"
#include "tests/synth/search/random_tables.h"

#include <string>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

MotionTable table() {
  test::Draw draw(5);
  test::TableShape shape;
  shape.sentences = 8;
  shape.emotions = 2;
  return test::random_table(shape, draw);
}

// pau, two phonemes, pau, one phoneme, pau: 0.1 s each.
std::vector<TimedPhoneme> transcript(const MotionTable& t) {
  std::vector<TimedPhoneme> rows;
  for (const std::size_t phoneme : {0, 1, 2, 0, 3, 0}) {
    const double start = 0.1 * static_cast<double>(rows.size());
    rows.push_back({.phoneme = t.phonemes[phoneme], .start_s = start, .end_s = start + 0.1});
  }
  return rows;
}

std::vector<EmotionModifier> emotions(std::size_t count, const std::string& emotion = "e0") {
  return std::vector<EmotionModifier>(count, EmotionModifier{.emotion = emotion});
}

NodeConstraint at_row(ConstraintKind kind, long row, std::vector<std::string> keys,
                      const std::string& where = "c.txt:1") {
  NodeConstraint constraint;
  constraint.kind = kind;
  constraint.index = row;
  constraint.keys = std::move(keys);
  constraint.where = where;
  return constraint;
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(TranscriptSteps, SilenceAtTheEndsTakesNoNodeAndInnerSilenceTakesAny) {
  const MotionTable t = table();
  const TranscriptSteps steps = make_transcript_steps(t, transcript(t), emotions(6), {});
  EXPECT_EQ(steps.first_row, 1u);
  ASSERT_EQ(steps.steps.size(), 4u);
  EXPECT_FALSE(steps.steps[0].is_silence);
  EXPECT_TRUE(steps.steps[2].is_silence);
  EXPECT_EQ(steps.steps[3].phoneme, 3);
  EXPECT_EQ(steps.steps[3].viseme, *t.find_viseme(t.phonemes[3].viseme));
}

TEST(TranscriptSteps, AllSilenceTakesNothing) {
  const MotionTable t = table();
  const std::vector<TimedPhoneme> rows = {{.phoneme = t.phonemes[0], .start_s = 0, .end_s = 1}};
  EXPECT_TRUE(make_transcript_steps(t, rows, emotions(1), {}).steps.empty());
}

TEST(TranscriptSteps, AUsePutsANodeOnSilenceAtAnEnd) {
  const MotionTable t = table();
  const TranscriptSteps steps = make_transcript_steps(
      t, transcript(t), emotions(6), std::vector{at_row(ConstraintKind::use, 5, {t.key(3)})});
  EXPECT_EQ(steps.first_row, 1u);
  ASSERT_EQ(steps.steps.size(), 5u);
  EXPECT_TRUE(steps.used[4]);
  EXPECT_EQ(steps.steps[4].allowed, std::vector<NodeIndex>{3});
}

TEST(TranscriptSteps, ConstraintsOnOneRowIntersectAndAvoidTakesAway) {
  const MotionTable t = table();
  const std::vector<NodeConstraint> constraints = {
      at_row(ConstraintKind::use, 1, {t.key(1), t.key(2), t.key(4)}),
      at_row(ConstraintKind::use, 1, {t.key(4), t.key(2)}),
      at_row(ConstraintKind::avoid, 1, {t.key(2)})};
  const TranscriptSteps steps = make_transcript_steps(t, transcript(t), emotions(6), constraints);
  EXPECT_EQ(steps.steps[0].allowed, (std::vector<NodeIndex>{2, 4}));
  EXPECT_EQ(steps.steps[0].avoided, std::vector<NodeIndex>{2});
}

TEST(TranscriptSteps, ATimeMeansTheRowItFallsIn) {
  const MotionTable t = table();
  NodeConstraint constraint = at_row(ConstraintKind::avoid, 0, {t.key(0)});
  constraint.index.reset();
  constraint.time_s = 0.2; // the start of row 2
  const TranscriptSteps steps =
      make_transcript_steps(t, transcript(t), emotions(6), std::vector{constraint});
  EXPECT_TRUE(steps.steps[0].avoided.empty());
  EXPECT_EQ(steps.steps[1].avoided, std::vector<NodeIndex>{0});
}

TEST(TranscriptSteps, ANodeOfAnotherPhonemeIsTakenWithAWarning) {
  const MotionTable t = table();
  NodeIndex other = 0;
  while (t.nodes[static_cast<std::size_t>(other)].phoneme == 1) {
    ++other;
  }
  const TranscriptSteps steps = make_transcript_steps(
      t, transcript(t), emotions(6), std::vector{at_row(ConstraintKind::use, 1, {t.key(other)})});
  ASSERT_FALSE(steps.warnings.empty());
  expect_contains(steps.warnings.front(), "c.txt:1");
  expect_contains(steps.warnings.front(), t.key(other));
}

TEST(TranscriptSteps, WhatCannotBeMetIsAnErrorThatNamesTheLine) {
  const MotionTable t = table();
  const auto error = [&](std::vector<NodeConstraint> constraints) {
    return test::input_error(
        [&] { make_transcript_steps(t, transcript(t), emotions(6), constraints); });
  };
  expect_contains(error({at_row(ConstraintKind::use, 9, {t.key(0)})}), "c.txt:1");
  expect_contains(error({at_row(ConstraintKind::use, 1, {"s/e0/nowhere#1"})}), "c.txt:1");
  expect_contains(error({at_row(ConstraintKind::use, 1, {t.key(0)}),
                         at_row(ConstraintKind::use, 1, {t.key(1)}, "c.txt:2")}),
                  "c.txt:2: the constraints on row 1 contradict each other");
  expect_contains(error({at_row(ConstraintKind::use, 1, {t.key(0)}),
                         at_row(ConstraintKind::avoid, 1, {t.key(0)}, "c.txt:2")}),
                  "contradict");
  std::vector<std::string> every;
  for (NodeIndex node = 0; node < t.node_count(); ++node) {
    every.push_back(t.key(node));
  }
  expect_contains(error({at_row(ConstraintKind::avoid, 1, every)}), "contradict");
  NodeConstraint late = at_row(ConstraintKind::use, 0, {t.key(0)});
  late.index.reset();
  late.time_s = 0.6; // the end belongs to no row
  expect_contains(error({late}), "the time is outside the transcript");
}

TEST(TranscriptSteps, AnUnknownEmotionIsRefusedAndIntensitiesAreNotLookedAt) {
  const MotionTable t = table();
  expect_contains(
      test::input_error([&] { make_transcript_steps(t, transcript(t), emotions(6, "e9"), {}); }),
      "Did you mean");
  std::vector<EmotionModifier> half = emotions(6);
  half[2].intensity = 0.5;
  const TranscriptSteps steps = make_transcript_steps(t, transcript(t), half, {});
  const TranscriptSteps whole = make_transcript_steps(t, transcript(t), emotions(6), {});
  for (std::size_t i = 0; i < whole.steps.size(); ++i) {
    EXPECT_EQ(steps.steps[i].emotion, whole.steps[i].emotion);
  }
}

TEST(TranscriptSteps, APhonemeNeverRecordedIsWarnedOfOnce) {
  const MotionTable t = table();
  std::vector<TimedPhoneme> rows = transcript(t);
  rows[1].phoneme = rows[2].phoneme = {"zh", "v1", Visibility::low};
  const TranscriptSteps steps = make_transcript_steps(t, rows, emotions(6), {});
  EXPECT_EQ(steps.steps[0].phoneme, -1);
  EXPECT_EQ(steps.steps[0].viseme, *t.find_viseme("v1"));
  ASSERT_EQ(steps.warnings.size(), 1u);
  expect_contains(steps.warnings[0], "/zh/");
}

} // namespace
} // namespace phonomime
