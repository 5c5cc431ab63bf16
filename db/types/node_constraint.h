// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

enum class ConstraintKind { use, avoid };

// One line of a constraint file (DESIGN 9): one of these nodes, or none of these, at a row of the
// transcript, given by its index (silence counts) or by a time.
struct NodeConstraint {
  ConstraintKind kind = ConstraintKind::use;
  std::optional<long> index = {}; // exactly one of index and time_s is set
  std::optional<double> time_s = {};
  std::vector<std::string> keys = {}; // node keys as typed
  std::string where;                  // "file:line", for messages
};

// The constraints of a text file (corpora_schema/constraints.md), in its order. `where` names the
// file. Throws InputError with file and line for a malformed line. Whether a node exists, and
// whether the constraints can be met together, is for the search's caller to say.
std::vector<NodeConstraint> parse_constraints(std::string_view text, std::string_view where);

} // namespace phonomime
