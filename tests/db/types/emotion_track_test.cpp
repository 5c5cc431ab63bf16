// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/emotion_track.h"

#include "tests/support/expect_error.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::input_error;

EmotionTrack track(std::string_view text) {
  return parse_emotion_track(text, "t.txt");
}

std::string track_error(std::string_view text) {
  return input_error([&] { track(text); });
}

std::vector<TimedPhoneme> phonemes(const std::vector<double>& borders_s) {
  std::vector<TimedPhoneme> rows;
  for (std::size_t i = 0; i + 1 < borders_s.size(); ++i) {
    rows.push_back({.phoneme = {"aa", "ae"}, .start_s = borders_s[i], .end_s = borders_s[i + 1]});
  }
  return rows;
}

const EmotionModifier kNeutral = {"neutral", 1.0};

TEST(EmotionTrack, ReadsLabelTracks) {
  const EmotionTrack read = track("# made by hand\r\n"
                                  "1.250000\t2.800000\thappiness 0.8\r\n"
                                  "\\\t1000.0\t2000.0\r\n"
                                  "\r\n"
                                  "0 1.25 neutral   # at first\r\n"
                                  "3.1\t4\tanger:1.5\r\n");
  EXPECT_EQ(read.source, "t.txt");
  ASSERT_EQ(read.spans.size(), 3u);
  EXPECT_EQ(read.spans[0].emotion, "neutral");
  EXPECT_EQ(read.spans[0].line, 5);
  EXPECT_EQ(read.spans[1].emotion, "happiness");
  EXPECT_EQ(read.spans[1].start_s, 1.25);
  EXPECT_EQ(read.spans[1].end_s, 2.8);
  EXPECT_EQ(read.spans[1].intensity, 0.8);
  EXPECT_EQ(read.spans[1].line, 2);
  EXPECT_EQ(read.spans[2].intensity, 1.5);
  EXPECT_TRUE(track("").spans.empty());
}

TEST(EmotionTrack, EachFaultIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"0 1", "t.txt:1: a line of an emotion track has 2 words (expected start end emotion "
              "[intensity], got \"0 1\")"},
      {"0 1 a 1 2", "t.txt:1: a line of an emotion track has 5 words"},
      {"\nx 1 a", "t.txt:2: the start of a span is not a time"},
      {"0 y a", "t.txt:1: the end of a span is not a time"},
      {"-1 1 a", "got \"-1\""},
      {"0 nan a", "the end of a span is not a time"},
      {"0 inf a", "the end of a span is not a time"},
      {"0 1,5 a", "the end of a span is not a time"},
      {"2 1 a",
       "t.txt:1: a span ends before it has begun (expected an end after the start, got 2 to "
       "1). Swap the two times."},
      {"1 1 a", "Give the label a length"},
      {"0 1 a 1.51",
       "t.txt:1: the intensity of an emotion is out of range (expected a number from 0 "
       "to 1.5, got \"1.51\")"},
      {"0 1 a -0.1", "out of range"},
      {"0 1 a nan", "out of range"},
      {"0 1 a:", "out of range"},
      {"0 1 a:0.5 0.5", "an intensity is given twice"},
      {"0 1 happiness+anger",
       "t.txt:1: the intensities of \"happiness+anger\" are too large together (expected 1.5 at "
       "most, got 2). Give each emotion its share, as in happiness:0.6+anger:0.3."},
      {"0 1 a:0.6+b:0.3+a:0.1", "names a twice"},
      {"0 1 a:0.6+", "an emotion has no usable name"},
      {"0 1 a:0.6+b:1.6", "out of range"},
      {"0 1 a:0.6+b:0.3 0.5", "an intensity is given twice"},
      {"0 1 :0.5", "an emotion has no usable name"},
      {"0 1 a/b", "an emotion has no usable name"},
      {"0 1 a\n2 3 b\n0.5 0.75 c",
       "t.txt:3: \"c\" overlaps line 1 (expected a start of at least 1 s, "
       "got 0.5 s)"},
      {"0 1 a\n0 1 a", "t.txt:2: \"a\" overlaps line 1"},
      {"0 1 \xFF", "t.txt: is not UTF-8 text"}};
  for (const auto& [text, message] : cases) {
    EXPECT_NE(track_error(text).find(message), std::string::npos)
        << text << "\ngave: " << track_error(text) << "\nnot:  " << message;
  }
  EXPECT_NO_THROW(track("0 1 a\n1 2 b"));
}

TEST(EmotionTrack, ModifierOfTheCommandLine) {
  EXPECT_EQ(parse_emotion_modifier("happiness", "--emotion"), (EmotionModifier{"happiness", 1.0}));
  EXPECT_EQ(parse_emotion_modifier("anger:0", "--emotion"), (EmotionModifier{"anger", 0.0}));
  EXPECT_THROW(parse_emotion_modifier("", "--emotion"), InputError);
  EXPECT_THROW(parse_emotion_modifier("a:2", "--emotion"), InputError);
  EXPECT_THROW(parse_emotion_modifier("a b", "--emotion"), InputError);
}

std::vector<std::string> emotions(std::string_view text, const std::vector<double>& borders_s) {
  std::vector<std::string> names;
  for (const EmotionModifier& modifier :
       assign_emotions(track(text), phonemes(borders_s), kNeutral)) {
    names.push_back(modifier.emotion);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(EmotionTrack, MixturesHaveAHeaviestPart) {
  const EmotionTrack read = track("0 1 a:0.3+b:0.6+c:0.6\n1 2 d");
  ASSERT_EQ(read.spans.size(), 2u);
  const EmotionMixture mixed = mixture_of(read.spans[0]);
  EXPECT_EQ(mixed.heaviest, (EmotionModifier{"b", 0.6}));
  ASSERT_EQ(mixed.others.size(), 2u);
  EXPECT_EQ(mixed.others[0], (EmotionModifier{"a", 0.3}));
  EXPECT_EQ(mixed.others[1], (EmotionModifier{"c", 0.6}));
  const EmotionMixture alone = mixture_of(read.spans[1]);
  EXPECT_EQ(alone.heaviest, (EmotionModifier{"d", 1.0}));
  EXPECT_TRUE(alone.others.empty());
  for (const char* text : {"b:0.6+a:0.3+c:0.6", "d", "e:0", "f:1.25"}) {
    EXPECT_EQ(format_emotions(parse_emotion_mixture(text, "t")), text);
  }
  EXPECT_THROW(parse_emotion_modifier("a:0.6+b:0.3", "t"), InputError);
  // A phoneme's emotion, as the search asks for it, is the heaviest part.
  const std::vector<double> borders_s = {0, 1, 2};
  const std::vector<EmotionModifier> found = assign_emotions(read, phonemes(borders_s), kNeutral);
  EXPECT_EQ(found[0], (EmotionModifier{"b", 0.6}));
}

TEST(AssignEmotions, TheLargestOverlapWins) {
  EXPECT_EQ(emotions("0 1 a\n1 2 b", {0, 0.5, 1.2, 2}), (Names{"a", "a", "b"}));
  EXPECT_EQ(emotions("0 1 a\n1 2 b", {0.7, 1.3}), Names{"a"}) << "ties go to the earlier";
  EXPECT_EQ(emotions("0.1 0.2 b\n0.2 0.3 a", {0.1, 0.3}), Names{"b"}) << "rounding breaks no tie";
  EXPECT_EQ(emotions("0 0.3 a\n0.3 0.7 b\n0.7 1 a", {0, 1}), Names{"a"}) << "pieces add up";
}

TEST(AssignEmotions, SilenceOfTheTrackIsTheFallback) {
  EXPECT_EQ(emotions("", {0, 1}), Names{"neutral"});
  EXPECT_EQ(emotions("1 2 a", {0, 0.5, 1, 1.5, 2, 3}),
            (Names{"neutral", "neutral", "a", "a", "neutral"}));
  EXPECT_EQ(emotions("0.6 1 a", {0, 1}), Names{"neutral"}) << "most of the phoneme";
  EXPECT_EQ(emotions("0.4 1 a", {0, 1}), Names{"a"});
  EXPECT_EQ(emotions("0 1 a", {0, 1, 1}), (Names{"a", "neutral"})) << "a row without duration";
}

TEST(AssignEmotions, IntensityIsThatOfTheLongestPiece) {
  const std::vector<EmotionModifier> found =
      assign_emotions(track("0 0.3 a 0.5\n0.3 0.5 b 0.2\n0.5 1 a 0.75\n1 2 a 1.25"),
                      phonemes({0, 1, 2, 3}), {"neutral", 0.9});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0], (EmotionModifier{"a", 0.75}));
  EXPECT_EQ(found[1], (EmotionModifier{"a", 1.25}));
  EXPECT_EQ(found[2], (EmotionModifier{"neutral", 0.9}));
}

// Against counting milliseconds, on random tracks over a grid of milliseconds.
TEST(AssignEmotions, AgreesWithCountingMilliseconds) {
  std::mt19937 random(7);
  const auto draw = [&](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  for (int round = 0; round < 200; ++round) {
    EmotionTrack made;
    std::vector<std::string> at(400, "neutral");
    for (int start = draw(40); start < 400;) {
      const int end = std::min(400, start + 1 + draw(80));
      const std::string emotion(1, static_cast<char>('a' + draw(3)));
      made.spans.push_back({.start_s = start / 1000.0, .end_s = end / 1000.0, .emotion = emotion});
      std::fill(at.begin() + start, at.begin() + end, emotion);
      start = end + (draw(2) == 0 ? 0 : draw(40));
    }
    std::vector<double> borders_s = {0.0};
    std::vector<int> borders = {0};
    while (borders.back() < 400) {
      borders.push_back(std::min(400, borders.back() + 1 + draw(60)));
      borders_s.push_back(borders.back() / 1000.0);
    }
    const std::vector<EmotionModifier> found = assign_emotions(made, phonemes(borders_s), kNeutral);
    ASSERT_EQ(found.size(), borders.size() - 1);
    for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
      std::vector<std::pair<std::string, int>> counts; // in order of first appearance
      for (int ms = borders[i]; ms < borders[i + 1]; ++ms) {
        const std::string& emotion = at[static_cast<std::size_t>(ms)];
        auto count = std::ranges::find(counts, emotion, &std::pair<std::string, int>::first);
        if (count == counts.end()) {
          count = counts.insert(counts.end(), {emotion, 0});
        }
        ++count->second;
      }
      const auto best = std::ranges::max_element(counts, {}, &std::pair<std::string, int>::second);
      EXPECT_EQ(found[i].emotion, best->first) << "round " << round << ", phoneme " << i;
    }
  }
}

} // namespace
} // namespace phonomime
