// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <span>
#include <vector>

namespace phonomime {

// The nodes of a table by phoneme, viseme and emotion: all that OC and EMP ask of a node.
class NodeClasses {
public:
  explicit NodeClasses(const MotionTable& table);

  std::int64_t node_count() const { return static_cast<std::int64_t>(nodes_.size()); }
  std::size_t size() const { return begins_.size() - 1; }

  // Nodes of one class, ascending; at least one.
  std::span<const NodeIndex> nodes(std::size_t class_index) const {
    return std::span(nodes_).subspan(begins_[class_index],
                                     begins_[class_index + 1] - begins_[class_index]);
  }

  // Of a node in its class.
  std::size_t place_of(NodeIndex node) const {
    return static_cast<std::size_t>(place_of_[static_cast<std::size_t>(node)]);
  }

  std::size_t class_of(NodeIndex node) const {
    return static_cast<std::size_t>(class_of_[static_cast<std::size_t>(node)]);
  }

private:
  std::vector<NodeIndex> nodes_;
  std::vector<std::size_t> begins_;
  std::vector<std::int32_t> class_of_; // per node
  std::vector<std::int32_t> place_of_; // per node
};

} // namespace phonomime
