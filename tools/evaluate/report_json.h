// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/evaluate/aggregate.h"
#include "tools/evaluate/compare.h"

#include <optional>

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// evaluation_json(), with the sentences' values or without.
nlohmann::ordered_json report_json(const Evaluation& evaluation,
                                   const std::optional<Comparison>& comparison,
                                   bool with_sentences);

} // namespace phonomime
