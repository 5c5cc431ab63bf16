// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/pipeline/synthesize.h"

#include <string>
#include <string_view>

namespace phonomime {

// A result file (result_to_json's text) as a table for people: per phoneme the node, how it joins,
// its cost terms and the runners-up. `where` names the file in errors. Throws InputError.
std::string explain_result(std::string_view json_text, std::string_view where);

// What a change of style did, in a line for people, without its end.
std::string style_to_text(const StyleOutcome& style);

} // namespace phonomime
