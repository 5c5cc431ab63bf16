// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/node_classes.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace phonomime {

NodeClasses::NodeClasses(const MotionTable& table)
    : nodes_(table.nodes.size()), class_of_(table.nodes.size()), place_of_(table.nodes.size()) {
  const auto key = [&](NodeIndex node) {
    const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
    return std::tuple(info.phoneme, info.viseme, info.emotion);
  };
  std::iota(nodes_.begin(), nodes_.end(), 0);
  std::ranges::stable_sort(nodes_, {}, key);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (i == 0 || key(nodes_[i]) != key(nodes_[i - 1])) {
      begins_.push_back(i);
    }
    const auto node = static_cast<std::size_t>(nodes_[i]);
    class_of_[node] = static_cast<std::int32_t>(begins_.size()) - 1;
    place_of_[node] = static_cast<std::int32_t>(i - begins_.back());
  }
  begins_.push_back(nodes_.size());
}

} // namespace phonomime
