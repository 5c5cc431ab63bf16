// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/node_constraint.h"
#include "db/types/phoneme_set.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// What all constraints on one row of a transcript ask for together.
struct RowConstraint {
  std::optional<std::vector<NodeIndex>> use; // sorted
  std::vector<NodeIndex> avoid;              // sorted
};

// Adds a constraint that holds on row `index`, which asks for `asked`. `warnings` gets a line for
// each node to use that was recorded as another phoneme. Throws InputError for a node that is
// unknown, ambiguous or pruned, and where no node is left.
void add_constraint(const MotionTable& table, const NodeConstraint& constraint, std::size_t index,
                    const TimedPhoneme& asked, RowConstraint& row,
                    std::vector<std::string>& warnings);

} // namespace phonomime
