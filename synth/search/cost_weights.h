// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

#include <string>
#include <string_view>

namespace phonomime {

// The shipped weights, the one place where they stand (corpora_schema/weights.md explains them):
// `paper` is the paper's cost alone, `context` adds terms beyond it (docs/cost.md). PNT is the
// database's own median ordinary join, so that the penalties keep their meaning from database to
// database: alpha1 = 1 makes a sentence start cost what an ordinary join costs.
CostWeights default_cost_weights(const MotionTable& table, CostModel model = CostModel::paper);

// The median of TC without penalties over a fixed sample of joins between nodes whose contexts
// agree in viseme (rule 2 of E Table I); 1 where the table has no such pair. Same table, same
// value.
double median_ordinary_join(const MotionTable& table, const CostWeights& weights);

// Throws InputError for a weight that is negative, not finite, an alpha4 outside (0, 1) or an
// off_lips above 1.
void check_cost_weights(const CostWeights& weights, std::string_view where);

// The weights of a weights file (JSON, corpora_schema/weights.md): a member that is left out keeps
// its value in `defaults`. Throws InputError.
CostWeights parse_cost_weights(std::string_view json_text, std::string_view where,
                               const CostWeights& defaults);

// A weights file that parse_cost_weights reads back as the same weights.
std::string format_cost_weights(const CostWeights& weights);

} // namespace phonomime
