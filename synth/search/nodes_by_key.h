// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <cstddef>
#include <span>
#include <vector>

namespace phonomime {

// Nodes in order of their keys, those of one key ascending.
struct NodesByKey {
  std::vector<NodeIndex> nodes;
  std::vector<std::size_t> begins; // of the keys that occur, ascending, in `nodes`; then its size

  std::size_t count() const { return begins.size() - 1; } // of the keys that occur
};

// `keys`: #nodes. Takes time and memory as the largest of them.
NodesByKey nodes_by_key(std::span<const std::size_t> keys);

} // namespace phonomime
