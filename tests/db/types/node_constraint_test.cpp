// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/node_constraint.h"

#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

std::vector<NodeConstraint> constraints(std::string_view text) {
  return parse_constraints(text, "c.txt");
}

TEST(NodeConstraint, ReadsEveryForm) {
  const std::vector<NodeConstraint> read =
      constraints("# by hand\n"
                  "12        use    happiness/s017#5              # the 13th phoneme\n"
                  "\n"
                  "at 1.25\tuse\ts1/happiness/s017#5 s020#3 #and why\n"
                  "31 avoid anger/s003#11\n"
                  "0 use a#b#0\n");
  ASSERT_EQ(read.size(), 4u);
  EXPECT_EQ(read[0].kind, ConstraintKind::use);
  EXPECT_EQ(read[0].index, 12);
  EXPECT_EQ(read[0].time_s, std::nullopt);
  EXPECT_EQ(read[0].keys, std::vector<std::string>{"happiness/s017#5"});
  EXPECT_EQ(read[0].where, "c.txt:2");
  EXPECT_EQ(read[1].index, std::nullopt);
  EXPECT_EQ(read[1].time_s, 1.25);
  EXPECT_EQ(read[1].keys, (std::vector<std::string>{"s1/happiness/s017#5", "s020#3"}));
  EXPECT_EQ(read[1].where, "c.txt:4");
  EXPECT_EQ(read[2].kind, ConstraintKind::avoid);
  EXPECT_EQ(read[2].index, 31);
  EXPECT_EQ(read[3].keys, std::vector<std::string>{"a#b#0"});
  EXPECT_TRUE(constraints("").empty());
  EXPECT_TRUE(constraints("# nothing\n  \n").empty());
}

TEST(NodeConstraint, EachFaultIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"12 use", "c.txt:1: a constraint is incomplete"},
      {"12", "c.txt:1: a constraint is incomplete"},
      {"at 1 use", "c.txt:1: a constraint is incomplete"},
      {"12 use #5", "c.txt:1: a constraint is incomplete"},
      {"\n1.25 use a#1",
       "c.txt:2: a constraint does not begin with a place (expected the index of a "
       "phoneme, counted from 0, or \"at SECONDS\", got \"1.25\"). A time is written "
       "\"at 1.25\"."},
      {"-1 use a#1", "got \"-1\")"},
      {"use a#1 b#2", "a constraint does not begin with a place"},
      {"99999999999999999999 use a#1", "a constraint does not begin with a place"},
      {"at x use a#1", "c.txt:1: the time of a constraint is not a time"},
      {"at -1 use a#1", "the time of a constraint is not a time"},
      {"at nan use a#1", "the time of a constraint is not a time"},
      {"at 1e999 use a#1", "the time of a constraint is not a time"},
      {"3 uses a#1",
       "c.txt:1: a constraint does not say what to do (expected \"use\" or \"avoid\", got "
       "\"uses\")"},
      {"3 use a", "c.txt:1: a constraint names something that is not the key of a motion node"},
      {"3 use a#", "is not the key of a motion node"},
      {"3 use a#x", "is not the key of a motion node"},
      {"3 use a#-1", "is not the key of a motion node"},
      {"3 use a#1 b", "got \"b\""},
      {"3 use \xC3#1", "c.txt: is not UTF-8 text"}};
  for (const auto& [text, message] : cases) {
    const std::string error = test::input_error([&, line = text] { constraints(line); });
    EXPECT_NE(error.find(message), std::string::npos)
        << text << "\ngave: " << error << "\nnot:  " << message;
  }
}

} // namespace
} // namespace phonomime
