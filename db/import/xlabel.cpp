// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/alignment_rows.h"
#include "db/import/readers.h"
#include "db/import/unicode.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <optional>

namespace phonomime {

namespace {

constexpr std::string_view kRowForm = "a row `end_time number label`";

[[noreturn]] void throw_bad_row(std::string_view where, long line, std::string_view row) {
  throw InputError({.where = at_line(where, line),
                    .what = "this is not a row of an xlabel file",
                    .expected = std::string(kRowForm),
                    .got = quoted(row)});
}

// `end_time number label`, label up to the separator.
AlignedLabel parse_row(std::string_view row, char separator, double start_s, std::string_view where,
                       long line) {
  const std::string_view fields = trim(row.substr(0, row.find(separator)));
  const std::vector<std::string_view> words = split_words(fields);
  const std::optional<double> end_s =
      words.size() >= 2 ? parse_number(words[0]) : std::optional<double>();
  if (!end_s || !parse_number(words[1])) {
    throw_bad_row(where, line, row);
  }
  const auto after_number =
      static_cast<std::size_t>(words[1].data() - fields.data()) + words[1].size();
  return {.label = std::string(trim(fields.substr(after_number))),
          .start_s = start_s,
          .end_s = *end_s,
          .line = line};
}

} // namespace

Alignment parse_xlabel(std::string_view bytes, std::string_view where) {
  const std::string text = decode_text(bytes, where);
  const std::vector<std::string_view> lines = split_lines(text);
  Alignment alignment{.source = std::string(where), .rows = {}};

  char separator = ';';
  std::size_t i = 0;
  for (; i < lines.size() && trim(lines[i]) != "#"; ++i) {
    const std::vector<std::string_view> words = split_words(lines[i]);
    if (words.size() == 2 && words[0] == "separator" && words[1].size() == 1) {
      separator = words[1][0];
    }
  }
  if (i == lines.size()) {
    throw InputError({.where = std::string(where),
                      .what = "the header of the xlabel file has no end",
                      .expected = "a line `#` before the rows"});
  }
  for (++i; i < lines.size(); ++i) {
    if (trim(lines[i]).empty()) {
      continue;
    }
    const double start_s = alignment.rows.empty() ? 0.0 : alignment.rows.back().end_s;
    append_row(alignment, parse_row(lines[i], separator, start_s, where, static_cast<long>(i + 1)));
  }
  require_rows(alignment);
  return alignment;
}

} // namespace phonomime
