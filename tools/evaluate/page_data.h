// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/evaluate/aggregate.h"
#include "tools/evaluate/compare.h"
#include "tools/evaluate/showcase.h"

#include <optional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// What the report's page reads: report_json() without the sentences, and
// - headlines: the measures of the first table, with short names;
// - sentence_values: every sentence's measures by method, to 5 digits;
// - face: groups, their mean pose, lines between neighbours, the size of a step of packed motion;
// - shown: the shown sentences, with packed motion (16 bits, little-endian, base64, steps from the
//   mean pose; thinned to about 50 Hz for the players, whole for some groups), curves and errors.
nlohmann::ordered_json page_data(const Evaluation& evaluation,
                                 const std::vector<ShownSentence>& shown,
                                 const std::optional<Comparison>& comparison);

} // namespace phonomime
