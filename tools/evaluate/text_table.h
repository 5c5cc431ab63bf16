// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// A table in plain text: the first column is aligned to the left, the others to the right.
class TextTable {
public:
  explicit TextTable(std::vector<std::string> header) : rows_{std::move(header)} {}

  // As many cells as the header has.
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  // One line a row, the header first.
  std::string text() const;

private:
  std::vector<std::vector<std::string>> rows_;
};

// With so many decimals, "-" where there is no value.
std::string shown(const std::optional<double>& value, int decimals);

} // namespace phonomime
