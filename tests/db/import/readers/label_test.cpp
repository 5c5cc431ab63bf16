// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/readers.h"
#include "tests/db/import/readers/textgrid_samples.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

struct Case {
  std::string text;
  const char* message;
};

struct Row {
  std::string label;
  double start_s;
  double end_s;
  long line;
};

void expect_rows(const Alignment& alignment, const std::vector<Row>& rows) {
  ASSERT_EQ(alignment.rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(alignment.rows[i].label, rows[i].label);
    EXPECT_DOUBLE_EQ(alignment.rows[i].start_s, rows[i].start_s);
    EXPECT_DOUBLE_EQ(alignment.rows[i].end_s, rows[i].end_s);
    EXPECT_EQ(alignment.rows[i].line, rows[i].line);
  }
}

TEST(Xlabel, RowsFollowOneAnother) {
  const std::string text = "#\n0.25 100 pau\n0.5 100 b\n1 100 ih\n";
  const std::vector<Row> rows = {{"pau", 0.0, 0.25, 2}, {"b", 0.25, 0.5, 3}, {"ih", 0.5, 1.0, 4}};
  expect_rows(parse_xlabel(text, "u.lab"), rows);
  expect_rows(parse_xlabel("\xEF\xBB\xBF" + text, "u.lab"), rows);
  expect_rows(parse_xlabel(test::to_utf16(text, true), "u.lab"), rows);
  EXPECT_EQ(parse_xlabel(text, "u.lab").source, "u.lab");
}

TEST(Xlabel, HeadersSeparatorsAndMissingLabels) {
  expect_rows(parse_xlabel("signal u17\nseparator ;\nnfields 1\n#\r\n"
                           "   0.25  26 \tpau ; name x ; score 3\r\n\r\n 0.5 -1\r\n1 26 ih ;\r\n",
                           "u.lab"),
              {{"pau", 0.0, 0.25, 5}, {"", 0.25, 0.5, 7}, {"ih", 0.5, 1.0, 8}});
  expect_rows(parse_xlabel("separator |\n#\n0.5 26 a;b | c\n", "u.lab"), {{"a;b", 0.0, 0.5, 3}});
}

// Festival ends some files so; what is done about it is not the reader's to say.
TEST(Xlabel, RowsWithoutDurationAreGivenAsTheyAre) {
  expect_rows(parse_xlabel("#\n0.5 100 b\n0.5 100 pau\n", "u.lab"),
              {{"b", 0.0, 0.5, 2}, {"pau", 0.5, 0.5, 3}});
}

TEST(Xlabel, HostileFiles) {
  const std::vector<Case> cases = {
      {"", "the header of the xlabel file has no end"},
      {"0.5 100 pau\n", "the header of the xlabel file has no end"},
      {"#\n", "the alignment has no rows"},
      {"#\n0.5 100 pau\n0.4 100 b\n",
       "u.lab:3: the times run backwards (expected an end after 0.5 s, got 0.4 s)"},
      {"#\n-1 100 pau\n", "u.lab:2: the row ends before it begins"},
      {"#\n0.5 pau\n", "u.lab:2: this is not a row of an xlabel file"},
      {"#\n0.5\n", "expected a row `end_time number label`, got \"0.5\""},
      {"#\nnan 100 pau\n", "u.lab:2: this is not a row"},
      {"#\ninf 100 pau\n", "u.lab:2: this is not a row"},
      {"#\n1e999 100 pau\n", "u.lab:2: this is not a row"},
      {"#\n0.5 100 \xC3\n", "is not well-formed UTF-8"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.message);
    test::expect_error([&] { parse_xlabel(c.text, "u.lab"); }, c.message);
  }
}

TEST(HtkLabel, TimesIn100Nanoseconds) {
  expect_rows(parse_htk_label("0 2500000 sil\n2500000 5000000 b -12.5 bin\n\n"
                              "6000000 10000000 \"ih\" -3.1\n",
                              "u.lab"),
              {{"sil", 0.0, 0.25, 1}, {"b", 0.25, 0.5, 2}, {"ih", 0.6, 1.0, 4}});
  expect_rows(parse_htk_label("0.0 2500000.0 sil\n", "u.lab"), {{"sil", 0.0, 0.25, 1}});
}

TEST(HtkLabel, SecondsWhereTheyCannotBeAnythingElse) {
  expect_rows(parse_htk_label("0.000000\t0.250000\tsil\n0.250000\t1\tb\n", "u.lab"),
              {{"sil", 0.0, 0.25, 1}, {"b", 0.25, 1.0, 2}});
}

TEST(HtkLabel, HostileFiles) {
  const std::vector<Case> cases = {
      {"", "the alignment has no rows"},
      {"0 1 sil\n1 2 b\n", "the labels would last 0.0002 ms in all"},
      {"0 40000 sil\n", "integer times in 100 ns (HTK), or seconds with a decimal point"},
      {"#!MLF!#\n\"*/u.lab\"\n0 2500000 sil\n.\n", "u.lab:1: HTK master label files (MLF)"},
      {"0 2500000 sil\n///\n0 2500000 pau\n", "u.lab:2: HTK label files with several alternatives"},
      {"0 2500000 sil\n.\n", "u.lab:2: HTK label files with several"},
      {"0 2500000 sil\n2400000 5000000 b\n", "u.lab:2: the row overlaps the one before it"},
      {"0 2500000 sil\n2500000 2400000 b\n", "u.lab:2: the times run backwards"},
      {"0 2500000 sil\n3000000 2800000 b\n", "u.lab:2: the row ends before it begins"},
      {"-5 2500000 sil\n", "u.lab:1: the row's time is before 0"},
      {"0 sil\n", "u.lab:1: this is not a row of a label file"},
      {"0.9175 100 pau\n1.0075 100 b\n", "u.lab:2: the row overlaps"},
      {"sil\n", "A Festival/xlabel file has a header that ends with a line `#`."},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.message);
    test::expect_error([&] { parse_htk_label(c.text, "u.lab"); }, c.message);
  }
}

} // namespace
} // namespace phonomime
