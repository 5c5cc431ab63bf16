// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/cli/arguments.h"

#include <nlohmann/json_fwd.hpp>

#include <string_view>

namespace phonomime {

// What was asked for, on stdout: JSON with --json, else the text, with --quiet too.
void print_answer(const CommonArguments& common, const nlohmann::ordered_json& json,
                  std::string_view text);

// What was done, the same way, but with --quiet no text. The progress line ends.
void print_report(const CommonArguments& common, const nlohmann::ordered_json& json,
                  std::string_view text);

} // namespace phonomime
