// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// What a table may hold beside its columns.
struct TabTableRules {
  bool comments = false;      // lines that begin with #
  bool other_columns = false; // columns of other names, which nobody asks for
};

// A table of tab-separated values, row after row: UTF-8 text with a header line that names the
// columns, in any order. Empty lines are passed over; fields that are missing at the end of a line
// are empty; white space around a field is not part of it.
class TabTable {
public:
  // `columns`: all that the table may have; `required`: indices into them. `text` and `columns`
  // must outlive the table; `where` names its file. Throws InputError, with the line: not UTF-8, no
  // header, an unknown, repeated or missing column.
  TabTable(std::string_view text, std::string_view where, std::span<const std::string_view> columns,
           std::span<const std::size_t> required, TabTableRules rules = {});

  bool has(std::size_t column) const { return field_of_[column] >= 0; }

  // Goes to the next row; false at the end. Throws InputError where it has more fields than the
  // header, or nothing in a required column.
  bool next();

  // Of this row; empty where the table lacks the column.
  std::string_view field(std::size_t column) const;

  long line() const { return static_cast<long>(next_line_); } // of this row, from 1
  std::string where() const;                                  // "path:line"

private:
  bool pass_over();
  void read_header(std::string_view line);

  std::string where_;
  std::span<const std::string_view> columns_;
  std::span<const std::size_t> required_;
  TabTableRules rules_;
  std::vector<std::string_view> lines_;
  std::size_t next_line_ = 0;
  std::size_t header_fields_ = 0;
  std::vector<std::ptrdiff_t> field_of_; // per column; -1 where the table lacks it
  std::vector<std::string_view> fields_; // of this row
};

} // namespace phonomime
