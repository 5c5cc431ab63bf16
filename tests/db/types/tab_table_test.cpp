// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/tab_table.h"

#include "tests/support/expect_error.h"

#include <array>
#include <utility>

#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

constexpr std::array<std::string_view, 3> kColumns = {"key", "value", "note"};
constexpr std::array<std::size_t, 1> kKey = {0};

using Row = std::pair<long, std::array<std::string, 3>>; // line, fields

std::vector<Row> rows_of(std::string_view text, TabTableRules rules = {}) {
  TabTable table(text, "t.tsv", kColumns, kKey, rules);
  std::vector<Row> rows;
  while (table.next()) {
    rows.push_back(
        {table.line(),
         {std::string(table.field(0)), std::string(table.field(1)), std::string(table.field(2))}});
  }
  return rows;
}

void expect_refused(std::string_view text, const std::string& part, TabTableRules rules = {}) {
  expect_error([&] { rows_of(text, rules); }, part);
}

TEST(TabTable, TakesColumnsInAnyOrderAndLinesOfAnyEnding) {
  EXPECT_EQ(rows_of("note\tkey\r\n\r\n n \t k\r\n\tl"),
            (std::vector<Row>{{3, {"k", "", "n"}}, {4, {"l", "", ""}}}));
  TabTable table("note\tkey\n", "t.tsv", kColumns, kKey);
  EXPECT_TRUE(table.has(0));
  EXPECT_FALSE(table.has(1));
  EXPECT_TRUE(table.has(2));
}

TEST(TabTable, PassesOverOnlyWhatItsRulesName) {
  const std::string_view text = "# made by hand\nkey\twho\tvalue\n#1\tann\t5\n";
  EXPECT_EQ(rows_of(text, {.comments = true, .other_columns = true}), std::vector<Row>{});
  EXPECT_EQ(rows_of(text.substr(text.find("key")), {.other_columns = true}),
            (std::vector<Row>{{2, {"#1", "5", ""}}}));
  expect_refused(text, "t.tsv:1: unknown column \"# made by hand\"");
  expect_refused(text, "t.tsv:2: unknown column \"who\" (expected key, value, note, separated by",
                 {.comments = true});
}

TEST(TabTable, SaysWhatIsWrongAndWhere) {
  expect_refused("", "t.tsv: table has no header line");
  expect_refused("value\tnote\n", "t.tsv:1: column \"key\" is missing");
  expect_refused("key\tkey\n", "t.tsv:1: column \"key\" is there twice");
  expect_refused("key\n\na\tb\n", "t.tsv:3: line has more fields than the header");
  expect_refused("key\tvalue\n\tb\n", "t.tsv:2: key is empty");
  expect_refused("key\nk\xff\n", "t.tsv:2: line is not UTF-8 text");
}

} // namespace
} // namespace phonomime::test
