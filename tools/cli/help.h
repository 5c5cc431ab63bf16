// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace phonomime {

// What `--help` says of one word or option: how it is written, and what it means.
struct HelpEntry {
  std::string term;
  std::string meaning;
};

struct HelpSection {
  std::string heading;
  std::vector<HelpEntry> entries;
};

struct HelpPage {
  std::string title;
  std::string usage;
  std::vector<HelpSection> sections; // those without entries are left out
  std::string footer;                // printed as it is
};

// The page as text, meanings in a column of their own, wrapped to 80 columns.
std::string format_help(const HelpPage& page);

} // namespace phonomime
