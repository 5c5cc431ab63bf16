// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/named_choice.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

std::size_t named_choice(std::string_view option, std::string_view name,
                         std::span<const std::string_view> choices) {
  const auto found = std::ranges::find(choices, name);
  if (found == choices.end()) {
    const std::vector<std::string> names(choices.begin(), choices.end());
    throw UsageError({.where = std::string(option),
                      .what = "there is no such choice",
                      .expected = fmt::format("one of {}", fmt::join(names, ", ")),
                      .got = quoted(name),
                      .remedy = did_you_mean(name, names)});
  }
  return static_cast<std::size_t>(found - choices.begin());
}

} // namespace phonomime
