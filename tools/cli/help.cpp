// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/help.h"

#include "db/types/text.h"

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kMeaningColumn = 26;

// Words in lines that begin at a column, where the first already is.
std::string in_lines(std::string_view words, std::size_t first_column) {
  std::string text;
  std::size_t column = first_column;
  for (const std::string_view word : split_words(words)) {
    if (column > first_column && column + 1 + word.size() > kWidth) {
      text += "\n" + std::string(first_column, ' ');
      column = first_column;
    } else if (column > first_column) {
      text += ' ';
      ++column;
    }
    text += word;
    column += word.size();
  }
  return text;
}

std::string format_entry(const HelpEntry& entry) {
  std::string text = "  " + entry.term;
  if (text.size() + 2 > kMeaningColumn) {
    text += "\n" + std::string(kMeaningColumn, ' ');
  } else {
    text.resize(kMeaningColumn, ' ');
  }
  return text + in_lines(entry.meaning, kMeaningColumn) + "\n";
}

} // namespace

std::string format_help(const HelpPage& page) {
  constexpr std::string_view kUsage = "Usage: ";
  std::string text =
      fmt::format("{}\n\n{}{}\n", page.title, kUsage, in_lines(page.usage, kUsage.size()));
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
