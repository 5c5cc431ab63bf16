// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/text_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace phonomime {

std::string TextTable::text() const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      widths.at(c) = std::max(widths.at(c), row[c].size());
    }
  }
  std::string text;
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += c == 0 ? fmt::format("{:<{}}", row[c], widths[c])
                     : fmt::format("  {:>{}}", row[c], widths[c]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string shown(const std::optional<double>& value, int decimals) {
  if (!value) {
    return "-";
  }
  // What rounds to zero has no sign.
  const double half = 0.5 * std::pow(10.0, -decimals);
  return fmt::format("{:.{}f}", std::abs(*value) < half ? 0.0 : *value, decimals);
}

} // namespace phonomime
