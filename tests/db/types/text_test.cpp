// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/text.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using namespace std::string_literals;
using Views = std::vector<std::string_view>;

TEST(Text, Utf8AsTheStandardHasIt) {
  // Unicode 15, table 3-7: the first and last sequence of each row, and their neighbours outside.
  const std::string good[] = {"",
                              "plain",
                              "\x01\x7F",
                              "\xC2\x80",
                              "\xDF\xBF",
                              "\xE0\xA0\x80",
                              "\xE0\xBF\xBF",
                              "\xEC\xBF\xBF",
                              "\xED\x80\x80",
                              "\xED\x9F\xBF",
                              "\xEE\x80\x80",
                              "\xEF\xBF\xBF",
                              "\xF0\x90\x80\x80",
                              "\xF3\xBF\xBF\xBF",
                              "\xF4\x8F\xBF\xBF",
                              "na\xC3\xAFve \xF0\x9F\x99\x82"};
  for (const std::string& text : good) {
    EXPECT_TRUE(is_valid_utf8(text)) << quoted(text);
  }
  const std::string bad[] = {"\x80"s, // continuation alone
                             "\xBF"s,
                             "\xC0\x80"s, // overlong NUL
                             "\xC1\xBF"s, // overlong
                             "\xE0\x80\x80"s,
                             "\xE0\x9F\xBF"s,
                             "\xF0\x80\x80\x80"s,
                             "\xF0\x8F\xBF\xBF"s,
                             "\xED\xA0\x80"s, // surrogates
                             "\xED\xBF\xBF"s,
                             "\xF4\x90\x80\x80"s, // above U+10FFFF
                             "\xF5\x80\x80\x80"s,
                             "\xFE"s,
                             "\xFF\xFE"s,
                             "\xC3"s, // cut short
                             "\xE2\x82"s,
                             "\xF0\x9F\x99"s,
                             "\xC3\x28"s, // not a continuation
                             "\xE2\x28\xA1"s,
                             "\xF0\x9F\x28\x82"s,
                             "a\0b"s}; // NUL
  for (const std::string& text : bad) {
    EXPECT_FALSE(is_valid_utf8(text)) << testing::PrintToString(text);
    EXPECT_FALSE(is_valid_utf8("before" + text)) << testing::PrintToString(text);
  }
}

TEST(Text, LinesOfEveryKind) {
  EXPECT_EQ(split_lines(""), Views{});
  EXPECT_EQ(split_lines("a\nb"), (Views{"a", "b"}));
  EXPECT_EQ(split_lines("a\nb\n"), (Views{"a", "b"}));
  EXPECT_EQ(split_lines("a\r\nb\r\n"), (Views{"a", "b"}));
  EXPECT_EQ(split_lines("a\rb\r"), (Views{"a", "b"}));
  EXPECT_EQ(split_lines("a\r\n\nb\n\rc"), (Views{"a", "", "b", "", "c"}));
  EXPECT_EQ(split_lines("\n\n"), (Views{"", ""}));
  EXPECT_EQ(split_lines("\xEF\xBB\xBF"
                        "a\n\xEF\xBB\xBF"),
            (Views{"a", "\xEF\xBB\xBF"}));
}

TEST(Text, FieldsAndWords) {
  EXPECT_EQ(split_fields("", '\t'), (Views{""}));
  EXPECT_EQ(split_fields("a\t\tb\t", '\t'), (Views{"a", "", "b", ""}));
  EXPECT_EQ(split_words(" \ta \t b  "), (Views{"a", "b"}));
  EXPECT_EQ(split_words(" \t"), Views{});
  EXPECT_EQ(trim(" \r\n\ta b\t\n"), "a b");
  EXPECT_EQ(trim(" \t"), "");
  EXPECT_EQ(to_lower("AZ[\xC3\x84]az09"), "az[\xC3\x84]az09");
}

TEST(Text, NumbersThatAreNumbers) {
  const std::pair<std::string_view, double> good[] = {
      {"0", 0.0},      {"-0.5", -0.5},   {"+2", 2.0},  {"1e-3", 0.001},
      {"1E3", 1000.0}, {".5", 0.5},      {"5.", 5.0},  {"007", 7.0},
      {"1.25", 1.25},  {"1e308", 1e308}, {"0.1", 0.1}, {"-1e-5", -1e-5}};
  for (const auto& [text, value] : good) {
    EXPECT_EQ(parse_number(text), value) << text;
  }
  for (const std::string_view text :
       {"",       " ",   "nan", "NaN",  "-nan", "nan(1)", "inf",   "-inf", "Infinity", "1e999",
        "-1e999", "0x1", "1,5", "1.5 ", " 1.5", "1.5s",   "--1",   "+-1",  "++1",      "-+1",
        "e3",     ".",   "+",   "-",    "1e",   "1 2",    "1_000", "1'000"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
  }
}

TEST(Text, IntegersThatAreIntegers) {
  EXPECT_EQ(parse_integer("0"), 0);
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("9223372036854775807"), std::numeric_limits<long>::max());
  for (const std::string_view text :
       {"", "9223372036854775808", "1.0", "1e3", "0x10", " 1", "1 ", "+", "-", "one"}) {
    EXPECT_EQ(parse_integer(text), std::nullopt) << text;
  }
}

TEST(Text, WrittenNumbersReadBackAsTheSame) {
  std::mt19937_64 bits(1);
  for (int i = 0; i < 10000; ++i) {
    const std::uint64_t pattern = bits();
    double value = 0.0;
    static_assert(sizeof value == sizeof pattern);
    std::memcpy(&value, &pattern, sizeof value);
    if (std::isnormal(value)) {
      EXPECT_EQ(parse_number(format_number(value)), value);
    }
  }
  EXPECT_EQ(format_number(1.25), "1.25");
}

TEST(Text, QuotedIsFitForAMessage) {
  EXPECT_EQ(quoted("aa"), "\"aa\"");
  EXPECT_EQ(quoted(std::string("aa")), "\"aa\"");
  EXPECT_EQ(quoted(std::string_view("a\x1B[31m\n\x80z")), "\"a?[31m??z\"");
  EXPECT_EQ(quoted(std::string(41, 'x')), "\"" + std::string(40, 'x') + "...\"");
  EXPECT_EQ(quoted(std::string(40, 'x')), "\"" + std::string(40, 'x') + "\"");
  EXPECT_TRUE(is_valid_utf8(quoted("\xF0\x9F\x99\x82\xF0\x9F")));
}

TEST(Text, NearestCandidatesFirst) {
  const std::vector<std::string> words = {"neutral", "happiness", "anger", "sadness", "Hanger"};
  EXPECT_EQ(nearest_candidates("happines", words), (std::vector<std::string>{"happiness"}));
  EXPECT_EQ(nearest_candidates("hanger", words), (std::vector<std::string>{"Hanger", "anger"}));
  EXPECT_EQ(nearest_candidates("hanger", words, 1), (std::vector<std::string>{"Hanger"}));
  EXPECT_EQ(nearest_candidates("qqqqq", words), std::vector<std::string>{});
  EXPECT_EQ(nearest_candidates(std::string(100000, 'a'), words), std::vector<std::string>{});
  EXPECT_EQ(did_you_mean("hanger", words), "Did you mean \"Hanger\" or \"anger\"?");
  EXPECT_EQ(did_you_mean("qqqqq", words), "");
}

} // namespace
} // namespace phonomime
