// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace phonomime {

// Which of an option's choices (into `choices`) a name is. Throws UsageError with all of them and
// the nearest.
std::size_t named_choice(std::string_view option, std::string_view name,
                         std::span<const std::string_view> choices);

} // namespace phonomime
