// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace phonomime::bench {

namespace {

std::string text_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) {
    return *text;
  }
  const double value = std::get<double>(cell);
  if (std::isnan(value)) {
    return "-";
  }
  return std::abs(value) >= 1000.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

void print_line(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout); // the next row may take a minute
}

} // namespace

void Report::section(const std::string& title, const std::vector<std::string>& columns) {
  constexpr std::size_t kLeastWidth = 7;
  columns_ = columns;
  widths_.clear();
  std::string line;
  for (const std::string& column : columns) {
    widths_.push_back(std::max(kLeastWidth, column.size()));
    line += fmt::format("{:>{}}  ", column, widths_.back());
  }
  print_line("\n" + title);
  print_line(line);
  json_["sections"].push_back({{"title", title},
                               {"rows", nlohmann::ordered_json::array()},
                               {"notes", nlohmann::ordered_json::array()}});
}

void Report::row(const std::vector<Cell>& cells) {
  std::string line;
  nlohmann::ordered_json row;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += fmt::format("{:>{}}  ", text_of(cells[i]), widths_.at(i));
    std::visit([&](const auto& value) { row[columns_[i]] = value; }, cells[i]);
  }
  print_line(line);
  json_["sections"].back()["rows"].push_back(row);
}

void Report::note(const std::string& text) {
  print_line("  " + text);
  json_["sections"].back()["notes"].push_back(text);
}

} // namespace phonomime::bench
