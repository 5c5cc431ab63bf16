// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "tests/db/import/readers/textgrid_samples.h"
#include "tests/support/expect_error.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::kLongTextGrid;
using test::kShortTextGrid;
using test::replaced;

void expect_sample(const Alignment& alignment) {
  ASSERT_EQ(alignment.rows.size(), 3U);
  const std::vector<std::string> labels = {"", "ɡ\"o", "ow"};
  const std::vector<double> ends_s = {0.25, 0.5, 0.9};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(alignment.rows[i].label, labels[i]);
    EXPECT_EQ(alignment.rows[i].start_s, i == 0 ? 0.0 : ends_s[i - 1]);
    EXPECT_EQ(alignment.rows[i].end_s, ends_s[i]);
  }
}

Alignment read(const std::string& bytes, const std::string& tier = {}) {
  return parse_textgrid(bytes, "t.TextGrid", tier);
}

TEST(TextGrid, LongAndShortFormInEveryEncoding) {
  for (const std::string& text : {kLongTextGrid, kShortTextGrid}) {
    expect_sample(read(text));
    expect_sample(read("\xEF\xBB\xBF" + text));
    expect_sample(read(test::to_utf16(text, false)));
    expect_sample(read(test::to_utf16(text, true)));
    std::string windows;
    for (const char c : text) {
      windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    }
    expect_sample(read(windows));
    expect_sample(read(replaced(text, "\"ooTextFile\"", "\"ooTextFile short\"")));
  }
}

TEST(TextGrid, RowsKnowTheirLine) {
  const auto line_before = [](const std::string& text, const std::string& part) {
    const auto begin = text.begin() + static_cast<std::ptrdiff_t>(text.find(part));
    return std::count(text.begin(), begin, '\n') + 1;
  };
  EXPECT_EQ(read(kLongTextGrid).rows[1].line, line_before(kLongTextGrid, "xmin = 0.25"));
  EXPECT_EQ(read(kShortTextGrid).rows[1].line, line_before(kShortTextGrid, "0.25\n0.5\n"));
}

TEST(TextGrid, CharactersBeyondTheBasicPlane) {
  // U+1D504 as the surrogate pair D835 DD04.
  std::string bytes = test::to_utf16(kShortTextGrid, false);
  const std::string label = test::to_utf16("ow", false).substr(2);
  bytes = replaced(bytes, label, std::string("\x35\xD8\x04\xDD", 4));
  EXPECT_EQ(read(bytes).rows[2].label, "\xF0\x9D\x94\x84");
}

TEST(TextGrid, CommentsAreNotRead) {
  std::string text = replaced(kShortTextGrid, "<exists>", "! 17 \"no\"\n<exists> ! 4");
  expect_sample(read(text));
}

TEST(TextGrid, LinesInsideLabels) {
  const Alignment plain = read(kLongTextGrid);
  const Alignment longer = read(replaced(kLongTextGrid, "\"the", "\"the\n\n"));
  EXPECT_EQ(longer.rows[0].line, plain.rows[0].line + 2);
}

TEST(TextGrid, TierByName) {
  const auto label = [](const std::string& name) {
    return read(replaced(kLongTextGrid, "\"Phones\"", "\"" + name + "\"")).rows[2].label;
  };
  for (const char* name : {"phones", "phone", "phonemes", "PHONEME", "Segments", "MAU", "phn",
                           "Ann - phones", "phones - Ann"}) {
    EXPECT_EQ(label(name), "ow") << name;
  }
  test::expect_error([&] { label("saxophones"); }, "a phone tier is not in the TextGrid");
  test::expect_error([&] { label("saxophones"); }, "\"words\", \"bells\" (points), \"saxophones\"");
}

TEST(TextGrid, PointsCalledPhonesAreNotMeant) {
  expect_sample(read(replaced(kLongTextGrid, "\"bells\"", "\"phones\"")));
}

TEST(TextGrid, TierGiven) {
  EXPECT_EQ(read(kLongTextGrid, "words").rows[0].label, "the \"go\" sign");
  EXPECT_EQ(read(kLongTextGrid, "WORDS").rows[0].label, "the \"go\" sign");
  expect_sample(read(kLongTextGrid, "Phones"));
  test::expect_error([] { read(kLongTextGrid, "syllables"); },
                     "tier \"syllables\" is not in the TextGrid");
  test::expect_error([] { read(kLongTextGrid, "bells"); },
                     "tier \"bells\" holds points, not intervals");
  const std::string twice = replaced(kLongTextGrid, "\"words\"", "\"phones\"");
  test::expect_error([&] { read(twice); }, "a phone tier is there 2 times");
  EXPECT_EQ(read(twice, "phones").rows.size(), 1U); // as written, before any case
}

TEST(TextGrid, GapsBetweenIntervalsAreLeftOut) {
  const Alignment alignment = read(replaced(kShortTextGrid, "0.25\n0.5\n\"ɡ", "0.3\n0.4\n\"ɡ"));
  EXPECT_EQ(alignment.rows[1].start_s, 0.3);
  EXPECT_EQ(alignment.rows[2].start_s, 0.5);
}

TEST(TextGrid, HostileFiles) {
  struct Case {
    std::string bytes;
    const char* message;
  };
  const std::string& s = kShortTextGrid;
  const std::vector<Case> cases = {
      {"", "t.TextGrid:1: the file type is missing (expected a string in quotes, got the end"},
      {"ooBinaryFile\x08TextGrid", "binary TextGrids (ooBinaryFile) are not supported"},
      {replaced(s, "ooTextFile", "ooTxt"), "is not a Praat text file"},
      {replaced(s, "TextGrid", "Sound"), "is not a TextGrid"},
      {replaced(s, "<exists>", "<absent>"), "the TextGrid has no tiers"},
      {replaced(s, "<exists>", ""), "the flag of the tiers is missing"},
      {replaced(s, "0\n0.9\n<e", "0.9\n0\n<e"), "the TextGrid ends before it begins"},
      {replaced(s, "0.25\n0.5\n\"ɡ", "0.25\n0.2\n\"ɡ"),
       "t.TextGrid:31: the times run backwards (expected an end after 0.25 s, got 0.2 s)"},
      {replaced(s, "0.25\n0.5\n\"ɡ", "0.2\n0.5\n\"ɡ"),
       "t.TextGrid:31: the row overlaps the one before"},
      {replaced(s, "0.5\n0.9\n\"ow", "0.6\n0.55\n\"ow"), "the row ends before it begins"},
      {replaced(s, "0.5\n0.9\n\"ow", "0.5\n0.95\n\"ow"),
       "the interval goes beyond tier \"Phones\""},
      {replaced(s, "0\n0.25\n\"\"", "-1\n0.25\n\"\""), "the interval goes beyond tier"},
      {replaced(s, "\"Phones\"\n0\n0.9", "\"Phones\"\n0\n2"),
       "tier \"Phones\" goes beyond the TextGrid"},
      {replaced(s, "\"Phones\"\n0\n0.9\n3", "\"Phones\"\n0\n0.9\n4"),
       "xmin of interval 4 is missing (expected a number, got the end of the file)"},
      {replaced(s, "\"Phones\"\n0\n0.9\n3", "\"Phones\"\n0\n0.9\n2"),
       "there is more in the file than its sizes say"},
      {replaced(s, "\"Phones\"\n0\n0.9\n3", "\"Phones\"\n0\n0.9\n999999999"),
       "is more than the file can hold"},
      {replaced(s, "\"Phones\"\n0\n0.9\n3", "\"Phones\"\n0\n0.9\n-3"), "is not a count"},
      {replaced(s, "\"Phones\"\n0\n0.9\n3", "\"Phones\"\n0\n0.9\n2.5"), "is not a count"},
      {replaced(s, "<exists>\n3", "<exists>\n900000000"), "the number of tiers is more than"},
      {replaced(s, "<exists>\n3", "<exists>\n2"), "there is more in the file than its sizes say"},
      {replaced(s, "\"TextTier\"", "\"MindTier\""), "tier 2 is of an unknown class"},
      {replaced(s, "\"ow\"", "\"ow"), "a string in quotes has no end"},
      {replaced(s, "0.5\n0.9\n\"ow", "0.5\n--undefined--\n\"ow"), "xmax of interval 3 is missing"},
      {s + "\xFF", "is not well-formed UTF-8"},
      {s + std::string(1, '\0'), "holds NUL bytes"},
      {test::to_utf16(s, true) + "x", "is not well-formed UTF-16"},
      {std::string("\xFF\xFE\x00\xD8", 4), "is not well-formed UTF-16"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.message);
    test::expect_error([&] { read(c.bytes); }, c.message);
  }
}

} // namespace
} // namespace phonomime
