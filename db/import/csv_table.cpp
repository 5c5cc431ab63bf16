// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/csv_table.h"

#include "db/import/unicode.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

CsvTable::CsvTable(std::string_view bytes, std::string_view where)
    : where_(where), text_(decode_text(bytes, where)), lines_(split_lines(text_)) {
  while (next_line_ < lines_.size() && trim(lines_[next_line_]).empty()) {
    ++next_line_;
  }
  if (next_line_ == lines_.size()) {
    throw InputError({.where = where_, .what = "the table is empty", .expected = "a header line"});
  }
  const std::string_view line = lines_[next_line_++];
  split(line);
  header_.assign(cells_.begin(), cells_.end());
  if (header_.size() == 1 && line.find_first_of(";\t") != std::string_view::npos) {
    fail("the fields are not separated by commas", "a header `name,name,...`", quoted(line),
         "Save the table again, with commas.");
  }
}

bool CsvTable::next() {
  while (next_line_ < lines_.size() && trim(lines_[next_line_]).empty()) {
    ++next_line_;
  }
  if (next_line_ == lines_.size()) {
    return false;
  }
  split(lines_[next_line_++]);
  if (cells_.size() != header_.size()) {
    fail("the row has another number of fields than the header",
         fmt::format("{} fields", header_.size()), std::to_string(cells_.size()),
         next_line_ == lines_.size() ? "The file seems to be cut off." : "");
  }
  return true;
}

void CsvTable::split(std::string_view line) {
  cells_.clear();
  if (line.find('"') == std::string_view::npos) {
    for (const std::string_view field : split_fields(line, ',')) {
      cells_.push_back(trim(field));
    }
    return;
  }
  unquoted_.clear();
  std::string field;
  bool in_quotes = false;
  const auto finish = [&] {
    unquoted_.emplace_back(trim(field));
    field.clear();
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && in_quotes && i + 1 < line.size() && line[i + 1] == '"') {
      field += line[i++];
    } else if (line[i] == '"') {
      in_quotes = !in_quotes;
    } else if (line[i] == ',' && !in_quotes) {
      finish();
    } else {
      field += line[i];
    }
  }
  finish();
  if (in_quotes) {
    fail("a quote has no end on its line");
  }
  cells_.assign(unquoted_.begin(), unquoted_.end());
}

float CsvTable::value(std::size_t column) const {
  const std::string_view cell = cells_[column];
  if (cell.empty() || (cell.size() == 3 && to_lower(cell) == "nan")) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  const std::optional<double> number = parse_number(cell);
  if (!number || std::abs(*number) > static_cast<double>(std::numeric_limits<float>::max())) {
    fail(fmt::format("column {} does not hold a number", quoted(header_[column])),
         "a decimal number, or nothing where it is missing", quoted(cell));
  }
  return static_cast<float>(*number);
}

void CsvTable::fail(std::string what, std::string expected, std::string got,
                    std::string remedy) const {
  throw InputError({.where = at_line(where_, line()),
                    .what = std::move(what),
                    .expected = std::move(expected),
                    .got = std::move(got),
                    .remedy = std::move(remedy)});
}

} // namespace phonomime
