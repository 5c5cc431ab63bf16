// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/help.h"

#include "db/types/text.h"

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kMeaningColumn = 26;

std::string format_entry(const HelpEntry& entry) {
  std::string text = "  " + entry.term;
  std::size_t column = text.size();
  const auto start_line = [&] {
    text += "\n" + std::string(kMeaningColumn, ' ');
    column = kMeaningColumn;
  };
  if (column + 2 > kMeaningColumn) {
    start_line();
  } else {
    text.append(kMeaningColumn - column, ' ');
    column = kMeaningColumn;
  }
  for (const std::string_view word : split_words(entry.meaning)) {
    const bool first = column == kMeaningColumn;
    if (!first && column + 1 + word.size() > kWidth) {
      start_line();
      text += word;
    } else {
      text += fmt::format("{}{}", first ? "" : " ", word);
      column += first ? 0 : 1;
    }
    column += word.size();
  }
  return text + "\n";
}

} // namespace

std::string format_help(const HelpPage& page) {
  std::string text = fmt::format("{}\n\nUsage: {}\n", page.title, page.usage);
  for (const HelpSection& section : page.sections) {
    if (!section.entries.empty()) {
      text += fmt::format("\n{}:\n", section.heading);
    }
    for (const HelpEntry& entry : section.entries) {
      text += format_entry(entry);
    }
  }
  return page.footer.empty() ? text : fmt::format("{}\n{}\n", text, page.footer);
}

} // namespace phonomime
