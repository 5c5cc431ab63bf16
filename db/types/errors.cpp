// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"

#include <fmt/format.h>

namespace phonomime {

std::string format_error(const ErrorDetails& details) {
  std::string text;
  if (!details.where.empty()) {
    text += details.where + ": ";
  }
  text += details.what;
  if (!details.expected.empty() && !details.got.empty()) {
    text += fmt::format(" (expected {}, got {})", details.expected, details.got);
  } else if (!details.expected.empty()) {
    text += fmt::format(" (expected {})", details.expected);
  } else if (!details.got.empty()) {
    text += fmt::format(" (got {})", details.got);
  }
  if (!details.remedy.empty()) {
    text += ". " + details.remedy;
  }
  return text;
}

Error::Error(ErrorClass error_class, ErrorDetails details)
    : std::runtime_error(format_error(details)), class_(error_class), details_(std::move(details)) {
}

std::string at_line(std::string_view path, long line) {
  return fmt::format("{}:{}", path, line);
}

} // namespace phonomime
