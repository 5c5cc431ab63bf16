// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/evaluate/aggregate.h"
#include "tools/evaluate/compare.h"
#include "tools/evaluate/showcase.h"

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// An aggregated evaluation as text for people: the methods' table with units, the tables by
// emotion, phoneme, region and marker of the main method, the sizes, the comparison, and each
// measure with its formula and mask.
std::string evaluation_text(const Evaluation& evaluation,
                            const std::optional<Comparison>& comparison);

// The same as JSON (format "phonomime-evaluation"), with every sentence's values; what
// parse_evaluation reads. A value that does not exist is null.
nlohmann::ordered_json evaluation_json(const Evaluation& evaluation,
                                       const std::optional<Comparison>& comparison);

// One line a method and sentence: method, key, speaker, emotion, fold, frames, then the measures by
// id. A value that does not exist is an empty field.
std::string sentences_csv(const Evaluation& evaluation);

// One HTML file that needs nothing else: tables, plots, the worst sentences, players.
std::string evaluation_html(const Evaluation& evaluation, const std::vector<ShownSentence>& shown,
                            const std::optional<Comparison>& comparison);

} // namespace phonomime
