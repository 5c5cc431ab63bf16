// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace phonomime {

// The report's page in its parts, as they are in page/.
struct PageTemplate {
  std::string_view html;   // with slots for title, style, data and script
  std::string_view style;  // report.css
  std::string_view script; // the scripts, one after the other
};
PageTemplate page_template();

} // namespace phonomime
