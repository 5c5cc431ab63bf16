// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/tab_table.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

constexpr std::size_t kNamesInAMessage = 20;

// "a", "a and b", "a, b and c"
std::string in_words(std::span<const std::string_view> columns,
                     std::span<const std::size_t> chosen) {
  std::string words;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    words += i == 0 ? "" : i + 1 == chosen.size() ? " and " : ", ";
    words += columns[chosen[i]];
  }
  return words;
}

} // namespace

TabTable::TabTable(std::string_view text, std::string_view where,
                   std::span<const std::string_view> columns, std::span<const std::size_t> required,
                   TabTableRules rules)
    : where_(where), columns_(columns), required_(required), rules_(rules),
      lines_(split_lines(text)) {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!is_valid_utf8(lines_[i])) {
      throw InputError({.where = at_line(where_, static_cast<long>(i + 1)),
                        .what = "line is not UTF-8 text",
                        .remedy = "Save the table as UTF-8."});
    }
  }
  if (!pass_over()) {
    throw InputError({.where = where_, .what = "table has no header line"});
  }
  read_header(lines_[next_line_++]);
}

// To the next line that says something; false at the end.
bool TabTable::pass_over() {
  while (next_line_ < lines_.size() && (trim(lines_[next_line_]).empty() ||
                                        (rules_.comments && lines_[next_line_].front() == '#'))) {
    ++next_line_;
  }
  return next_line_ < lines_.size();
}

void TabTable::read_header(std::string_view line) {
  field_of_.assign(columns_.size(), -1);
  const std::vector<std::string_view> fields = split_fields(line, '\t');
  header_fields_ = fields.size();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view name = trim(fields[i]);
    const auto column = std::ranges::find(columns_, name);
    if (column == columns_.end()) {
      if (rules_.other_columns) {
        continue;
      }
      const std::vector<std::string> known(columns_.begin(), columns_.end());
      throw InputError(
          {.where = where(),
           .what = fmt::format("unknown column {}", quoted(name)),
           .expected = known.size() > kNamesInAMessage
                           ? std::string()
                           : fmt::format("{}, separated by tabs", fmt::join(columns_, ", ")),
           .remedy = did_you_mean(name, known)});
    }
    std::ptrdiff_t& field = field_of_[static_cast<std::size_t>(column - columns_.begin())];
    if (field >= 0) {
      throw InputError(
          {.where = where(), .what = fmt::format("column {} is there twice", quoted(name))});
    }
    field = static_cast<std::ptrdiff_t>(i);
  }
  for (const std::size_t column : required_) {
    if (field_of_[column] < 0) {
      throw InputError({.where = where(),
                        .what = fmt::format("column \"{}\" is missing", columns_[column]),
                        .expected = fmt::format("a header line with at least {}, separated by tabs",
                                                in_words(columns_, required_)),
                        .got = quoted(line)});
    }
  }
}

bool TabTable::next() {
  if (!pass_over()) {
    return false;
  }
  fields_ = split_fields(lines_[next_line_++], '\t');
  if (fields_.size() > header_fields_) {
    throw InputError({.where = where(),
                      .what = "line has more fields than the header",
                      .expected = fmt::format("{}", header_fields_),
                      .got = fmt::format("{}", fields_.size())});
  }
  for (const std::size_t column : required_) {
    if (field(column).empty()) {
      throw InputError({.where = where(), .what = fmt::format("{} is empty", columns_[column])});
    }
  }
  return true;
}

std::string_view TabTable::field(std::size_t column) const {
  const std::ptrdiff_t place = field_of_[column];
  return place < 0 || place >= static_cast<std::ptrdiff_t>(fields_.size())
             ? std::string_view()
             : trim(fields_[static_cast<std::size_t>(place)]);
}

std::string TabTable::where() const {
  return at_line(where_, line());
}

} // namespace phonomime
