// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/stream_transcript.h"

#include "db/import/readers.h"
#include "db/types/errors.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

std::vector<PhonemeSet> two_sets() {
  return {PhonemeSet::built_in("arpabet"), PhonemeSet::built_in("festival_us")};
}

std::vector<StreamRow> read_all(StreamTranscript& stream, const std::vector<std::string>& lines) {
  std::vector<StreamRow> rows;
  for (const std::string& line : lines) {
    for (StreamRow& row : stream.read(line)) {
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

// The same rows, to the bit, as a file with the same times gives.
TEST(StreamTranscript, ReadsWhatAFileSays) {
  const std::vector<std::string> lines = {"# said now",        "0.25 0.3 b",      "",
                                          "0.3\t0.47 aa\r",    "0.4699999 0.6 m", "  0.6 0.6 pau  ",
                                          "0.6000005 0.7 sil", "1.1 1.1 pau",     "1.1 1.2 iy"};
  std::string text;
  for (const std::string& line : lines) {
    text += line.starts_with('#') ? "" : line + "\n";
  }
  StreamTranscript stream(two_sets(), {}, "standard input");
  const std::vector<StreamRow> rows = read_all(stream, lines);
  const std::vector<TimedPhoneme> expected =
      to_phonemes(parse_htk_label(text, "file.lab"), PhonemeSet::built_in("arpabet"));
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].phoneme.phoneme, expected[i].phoneme);
    EXPECT_EQ(rows[i].phoneme.start_s, expected[i].start_s);
    EXPECT_EQ(rows[i].phoneme.end_s, expected[i].end_s);
  }
}

TEST(StreamTranscript, AnEmotionHoldsForItsRowOnly) {
  AskedEmotions asked{.track = {.source = "track", .spans = {{0.0, 0.3, "anger", 1.0, 1}}},
                      .fallback = {.heaviest = {.emotion = "sadness"}}};
  StreamTranscript stream(two_sets(), asked, "standard input");
  std::vector<std::string> emotions;
  for (const StreamRow& row :
       read_all(stream, {"0.1 0.2 b happiness", "0.2 0.3 aa", "0.5 0.6 m neutral", "0.6 0.7 iy"})) {
    emotions.push_back(row.emotion.emotion);
  }
  EXPECT_EQ(emotions, (std::vector<std::string>{"anger", "happiness", "anger", "sadness", "neutral",
                                                "sadness"}));
}

TEST(StreamTranscript, TakesTheFirstAlphabetThatKnowsAllSoFar) {
  StreamTranscript stream({PhonemeSet::built_in("arpabet"), PhonemeSet::built_in("timit")}, {},
                          "standard input");
  EXPECT_EQ(read_all(stream, {"0 0.1 AA1"}).size(), 1u); // arpabet alone
  EXPECT_THROW(stream.read("0.1 0.2 bcl"), InputError);  // timit alone
  StreamTranscript other({PhonemeSet::built_in("arpabet"), PhonemeSet::built_in("timit")}, {},
                         "standard input");
  EXPECT_EQ(read_all(other, {"0 0.1 aa", "0.1 0.2 bcl", "0.2 0.3 b"}).size(), 3u);
}

TEST(StreamTranscript, RefusesABadLineByItsNumber) {
  const auto refusal = [](const std::string& line) -> std::string {
    StreamTranscript stream(two_sets(), {}, "standard input");
    read_all(stream, {"# two lines before", "0.1 0.2 b"});
    try {
      stream.read(line);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("0.2 0.3 aa"), "");
  for (const char* line :
       {"0.2 0.3", "0.2 0.3 aa neutral now", "x 0.3 aa", "0.2 nan aa", "0.1 0.3 aa", "0.2 0.15 aa",
        "0.3 0.25 aa", "-1 0.3 aa", "0.2 0.2 aa", "0.2 0.3 qqq", "0.2 0.3 aa neutral:9",
        "0.2 9000 aa", "0.2 inf aa", "0.2 0.3 \xff"}) {
    EXPECT_TRUE(refusal(line).starts_with("standard input:3: ")) << line << ": " << refusal(line);
  }
}

} // namespace
} // namespace phonomime
