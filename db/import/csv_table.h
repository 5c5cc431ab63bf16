// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// A table of comma-separated values, row after row: LF or CRLF ends, empty lines passed over,
// fields with or without quotes and with white space around them.
class CsvTable {
public:
  // Reads the header. Throws InputError where the bytes are not text or there is no header.
  CsvTable(std::string_view bytes, std::string_view where);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  const std::vector<std::string>& header() const { return header_; }

  // Goes to the next row; false at the end. Throws InputError where it has more or fewer fields
  // than the header.
  bool next();

  const std::vector<std::string_view>& cells() const { return cells_; }
  long line() const { return static_cast<long>(next_line_); } // of this row, from 1

  // A finite number that fits a float, or NaN for a field that is empty or `nan`. Throws
  // InputError.
  float value(std::size_t column) const;

  // Throws InputError for this row.
  [[noreturn]] void fail(std::string what, std::string expected = {}, std::string got = {},
                         std::string remedy = {}) const;

private:
  void split(std::string_view line);

  std::string where_;
  std::string text_;
  std::vector<std::string_view> lines_; // into text_
  std::size_t next_line_ = 0;
  std::vector<std::string> header_;
  std::vector<std::string> unquoted_; // what the cells of a row with quotes point into
  std::vector<std::string_view> cells_;
};

} // namespace phonomime
