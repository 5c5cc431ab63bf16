// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace phonomime {

enum class ConstraintKind { use, avoid };

// One line of a constraint file (DESIGN 9): one of these nodes, or none of these, at a row of the
// transcript, given by its index (silence counts) or by a time.
struct NodeConstraint {
  ConstraintKind kind = ConstraintKind::use;
  std::optional<long> index;    // exactly one of index and time_s is set
  std::optional<double> time_s;
  std::vector<std::string> keys;  // node keys as typed
  std::string where;              // "file:line", for messages
};

}  // namespace phonomime
