// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/nodes_by_key.h"

#include <algorithm>

namespace phonomime {

NodesByKey nodes_by_key(std::span<const std::size_t> keys) {
  std::vector<std::size_t> next(keys.empty() ? 0 : *std::ranges::max_element(keys) + 1, 0);
  for (const std::size_t key : keys) {
    ++next[key];
  }
  NodesByKey sorted;
  std::size_t begin = 0;
  for (std::size_t& count : next) { // becomes where the key's next node goes
    if (count > 0) {
      sorted.begins.push_back(begin);
    }
    begin += count;
    count = begin - count;
  }
  sorted.begins.push_back(begin);
  sorted.nodes.resize(keys.size());
  for (std::size_t node = 0; node < keys.size(); ++node) {
    sorted.nodes[next[keys[node]]++] = static_cast<NodeIndex>(node);
  }
  return sorted;
}

} // namespace phonomime
