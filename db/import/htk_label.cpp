// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/alignment_rows.h"
#include "db/import/readers.h"
#include "db/import/unicode.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kTicksPerSecond = 1e7;     // HTK counts in 100 ns
constexpr double kLargestSeconds = 1e5;     // over a day: no recording of one sentence
constexpr double kSmallestTotalTicks = 5e5; // 50 ms: no sentence is shorter
constexpr std::string_view kXlabelHint =
    "A Festival/xlabel file has a header that ends with a line `#`.";

struct Row {
  double start = 0.0;
  double end = 0.0;
  std::string label;
  long line = 0;
};

// A label may stand in quotes, as HTK allows where it has odd characters.
std::string unquote(std::string_view word) {
  if (word.size() >= 2 && (word.front() == '"' || word.front() == '\'') &&
      word.back() == word.front()) {
    word = word.substr(1, word.size() - 2);
  }
  return std::string(word);
}

Row parse_row(std::string_view text, std::string_view where, long line) {
  const std::vector<std::string_view> words = split_words(text);
  const auto number = [&](std::size_t i) {
    return i < words.size() ? parse_number(words[i]) : std::nullopt;
  };
  const std::optional<double> start = number(0);
  const std::optional<double> end = number(1);
  if (!start || !end) {
    throw InputError({.where = at_line(where, line),
                      .what = "this is not a row of a label file",
                      .expected = "a row `start end label`",
                      .got = quoted(text),
                      .remedy = std::string(kXlabelHint)});
  }
  return {*start, *end, words.size() > 2 ? unquote(words[2]) : std::string(), line};
}

void refuse_master_files(std::string_view line_text, std::string_view where, long line) {
  if (line_text == "#!MLF!#") {
    throw InputError({.where = at_line(where, line),
                      .what = "HTK master label files (MLF) are not supported",
                      .expected = "the labels of one sentence",
                      .remedy = "Split it into one label file a sentence."});
  }
  if (line_text.starts_with("///") || line_text == ".") {
    throw InputError(
        {.where = at_line(where, line),
         .what = "HTK label files with several alternatives or entries are not supported",
         .expected = "rows `start end label`",
         .got = quoted(line_text),
         .remedy = "Keep the first alternative only."});
  }
}

// How many of the file's units make a second. Throws InputError where it cannot be told.
double units_per_second(const std::vector<Row>& rows, bool has_decimal_point,
                        std::string_view where) {
  double largest = 0.0;
  for (const Row& row : rows) {
    largest = std::max({largest, row.start, row.end});
  }
  if (has_decimal_point && largest < kLargestSeconds) {
    return 1.0;
  }
  if (largest < kSmallestTotalTicks) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("the labels would last {:.3g} ms in all",
                                          largest / kTicksPerSecond * 1e3),
                      .expected = "integer times in 100 ns (HTK), or seconds with a decimal point",
                      .remedy = std::string(kXlabelHint)});
  }
  return kTicksPerSecond;
}

} // namespace

Alignment parse_htk_label(std::string_view bytes, std::string_view where) {
  const std::string text = decode_text(bytes, where);
  const std::vector<std::string_view> lines = split_lines(text);
  std::vector<Row> rows;
  bool has_decimal_point = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line_text = trim(lines[i]);
    const long line = static_cast<long>(i + 1);
    if (line_text.empty()) {
      continue;
    }
    refuse_master_files(line_text, where, line);
    rows.push_back(parse_row(line_text, where, line));
    const std::vector<std::string_view> words = split_words(line_text);
    has_decimal_point = has_decimal_point || words[0].find('.') != std::string_view::npos ||
                        words[1].find('.') != std::string_view::npos;
  }

  Alignment alignment{.source = std::string(where), .rows = {}};
  const double per_second = rows.empty() ? 1.0 : units_per_second(rows, has_decimal_point, where);
  for (Row& row : rows) {
    append_row(alignment, {.label = std::move(row.label),
                           .start_s = row.start / per_second,
                           .end_s = row.end / per_second,
                           .line = row.line});
  }
  require_rows(alignment);
  return alignment;
}

} // namespace phonomime
