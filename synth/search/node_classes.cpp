// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/node_classes.h"

#include "synth/search/nodes_by_key.h"

#include <utility>

namespace phonomime {

NodeClasses::NodeClasses(const MotionTable& table)
    : class_of_(table.nodes.size()), place_of_(table.nodes.size()) {
  std::vector<std::size_t> keys;
  keys.reserve(table.nodes.size());
  for (const MotionNode& node : table.nodes) {
    keys.push_back((static_cast<std::size_t>(node.phoneme) * table.visemes.size() +
                    static_cast<std::size_t>(node.viseme)) *
                       table.emotions.size() +
                   static_cast<std::size_t>(node.emotion));
  }
  NodesByKey sorted = nodes_by_key(keys);
  nodes_ = std::move(sorted.nodes);
  begins_ = std::move(sorted.begins);
  for (std::size_t c = 0; c + 1 < begins_.size(); ++c) {
    for (std::size_t i = begins_[c]; i < begins_[c + 1]; ++i) {
      const auto node = static_cast<std::size_t>(nodes_[i]);
      class_of_[node] = static_cast<std::int32_t>(c);
      place_of_[node] = static_cast<std::int32_t>(i - begins_[c]);
    }
  }
}

} // namespace phonomime
