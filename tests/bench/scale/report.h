// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

namespace phonomime::bench {

using Cell = std::variant<std::string, double>; // a NaN is printed as "-"

// Results as tables on standard output, row by row as they come, and as JSON.
class Report {
public:
  void section(const std::string& title, const std::vector<std::string>& columns);
  void row(const std::vector<Cell>& cells);
  void note(const std::string& text);

  // {"sections": [{"title", "rows": [{column: value}], "notes": [text]}]}
  const nlohmann::ordered_json& json() const { return json_; }

private:
  std::vector<std::string> columns_;
  std::vector<std::size_t> widths_;
  nlohmann::ordered_json json_ = {{"sections", nlohmann::ordered_json::array()}};
};

} // namespace phonomime::bench
