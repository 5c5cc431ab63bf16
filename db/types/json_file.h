// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string_view>

namespace phonomime {

// The JSON value of a text. `where` names the file. Throws InputError with line and column.
nlohmann::json parse_json(std::string_view text, std::string_view where);

// Checks a value against corpora_schema/schemas/<schema>.schema.json. Throws InputError with the
// path of the first member that does not fit, and why.
void validate_json(const nlohmann::json& value, std::string_view schema, std::string_view where);

// Both.
nlohmann::json parse_json_as(std::string_view schema, std::string_view text,
                             std::string_view where);

} // namespace phonomime
