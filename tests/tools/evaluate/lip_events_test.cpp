// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/lip_events.h"

#include "tests/tools/evaluate/made_sentences.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

using enum Measure;

// The lips close in both /b/, and in /m/ not quite.
ImportedSentence closing_sentence() {
  ImportedSentence sentence = made_sentence(
      {{"pau", 10}, {"b", 10}, {"aa", 20}, {"b", 10}, {"iy", 20}, {"m", 10}, {"pau", 10}});
  set_aperture(sentence.channels, [](int k) {
    return k == 15 || k == 45 ? 0.5 : k == 75 ? 1.6 : 8.0;
  });
  return sentence;
}

MeasureValues measured(const ImportedSentence& sentence, const FrameMatrix& synthesised) {
  return measure_values(measure_sentence(made_setup(), sentence, synthesised, {}).sums);
}

TEST(LipEvents, CountsClosuresByRow) {
  const ImportedSentence sentence = closing_sentence();
  FrameMatrix synthesised = sentence.channels;
  const MeasureValues kept = measured(sentence, synthesised);
  EXPECT_NEAR(*kept[closure_recall], 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(*kept[closure_recall_recorded], 2.0 / 3.0, 1e-12);
  EXPECT_EQ(kept[closure_kept], 1.0);
  EXPECT_FALSE(kept[contact_error]); // no /f v/
}

TEST(LipEvents, ARemovedClosureIsMissedAndAnAddedOneIsNot) {
  const ImportedSentence sentence = closing_sentence();
  FrameMatrix synthesised = sentence.channels;
  synthesised.row(45) = synthesised.row(44); // the second /b/ stays open
  const MeasureValues removed = measured(sentence, synthesised);
  EXPECT_NEAR(*removed[closure_recall], 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(*removed[closure_recall_recorded], 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(*removed[closure_kept], 1.0 / 2.0, 1e-12);
  set_aperture(synthesised, [](int k) { return k == 15 || k == 45 || k == 75 ? -0.2 : 8.0; });
  const MeasureValues added = measured(sentence, synthesised);
  EXPECT_EQ(added[closure_recall], 1.0);
  EXPECT_EQ(added[closure_kept], 1.0);
}

TEST(LipEvents, AClosureInTheNeighbourIsNoClosure) {
  const ImportedSentence sentence = closing_sentence();
  FrameMatrix synthesised = sentence.channels;
  synthesised.row(45) = synthesised.row(44);
  set_aperture(synthesised, [](int k) { return k == 15 || k == 51 ? 0.5 : 8.0; });
  EXPECT_NEAR(*measured(sentence, synthesised)[closure_recall], 1.0 / 3.0, 1e-12);
  // Its time is still found: the second /b/'s minimum is 6 frames late.
  const SentenceMeasures whole = measure_sentence(made_setup(), sentence, synthesised, {});
  ASSERT_EQ(whole.lip_events.size(), 3u);
  EXPECT_NEAR(whole.lip_events[1].timing_s, 0.06, 1e-12);
  EXPECT_EQ(whole.lip_events[1].row, 3);
}

TEST(LipEvents, OfEqualMinimaTheFirstCounts) {
  ImportedSentence sentence = closing_sentence();
  FrameMatrix synthesised = sentence.channels;
  sentence.channels.row(46) = sentence.channels.row(45);
  EXPECT_EQ(measure_sentence(made_setup(), sentence, synthesised, {}).lip_events[1].timing_s, 0.0);
}

TEST(LipEvents, FramesWithGapsAreNotLookedAt) {
  ImportedSentence sentence = closing_sentence();
  sentence.frame_has_gap[15] = 1;
  EXPECT_NEAR(*measured(sentence, sentence.channels)[closure_recall], 1.0 / 3.0, 1e-12);
  std::fill_n(sentence.frame_has_gap.begin() + 10, 10, std::uint8_t{1}); // all of the first /b/
  EXPECT_NEAR(*measured(sentence, sentence.channels)[closure_recall], 1.0 / 2.0, 1e-12);
}

TEST(LipEvents, ContactRangesAreThePercentilesOfTheRecordings) {
  std::vector<LipEvent> events;
  for (int i = 0; i <= 20; ++i) { // 0, 1, ..., 20 mm in an order of its own
    events.push_back(
        {.phoneme = "f", .demand = LipDemand::contact, .recorded_aperture_mm = (i * 8) % 21 + 0.0});
    events.push_back({.phoneme = "b", .demand = LipDemand::closure});
  }
  events.push_back({.phoneme = "v", .demand = LipDemand::contact}); // too few
  const auto ranges = contact_ranges(events);
  ASSERT_EQ(ranges.size(), 1u);
  EXPECT_NEAR(ranges.at("f").low_mm, 2.0, 1e-12);
  EXPECT_NEAR(ranges.at("f").high_mm, 18.0, 1e-12);
  EXPECT_EQ(ranges.at("f").rows, 21);
  EXPECT_TRUE(ranges.at("f").holds(2.0) && ranges.at("f").holds(18.0));
  EXPECT_FALSE(ranges.at("f").holds(1.99) || ranges.at("f").holds(18.01));
}

TEST(LipEvents, NamesWhatEachPhonemeAsksFor) {
  for (const char* name : {"p", "b", "m"}) {
    EXPECT_EQ(lip_demand({name, name}), LipDemand::closure);
  }
  for (const char* name : {"f", "v"}) {
    EXPECT_EQ(lip_demand({name, name}), LipDemand::contact);
  }
  for (const char* name : {"pau", "w", "aa", "t"}) {
    EXPECT_EQ(lip_demand({name, name}), LipDemand::none);
  }
}

} // namespace
} // namespace phonomime::test
