// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace phonomime {

// Fixed-size float records for some nodes of a table, made when they are first asked for. Records
// stay where they are once made.
class NodeRecords {
public:
  NodeRecords(std::size_t node_count, std::size_t record_floats)
      : record_floats_(record_floats), slots_(node_count, kAbsent) {}

  // Only for nodes that ensure() has seen.
  const float* operator[](NodeIndex node) const {
    const auto slot = static_cast<std::size_t>(slots_[static_cast<std::size_t>(node)]);
    return blocks_[slot / kBlockNodes].get() + (slot % kBlockNodes) * record_floats_;
  }

  // Calls make(node, float* record) over threads for the nodes that have no record yet; `make` has
  // to write all of it, and must not throw. Not for parallel regions.
  template <typename Make>
  void ensure(std::span<const NodeIndex> nodes, const Make& make) {
    std::vector<NodeIndex> missing;
    for (const NodeIndex node : nodes) {
      std::int32_t& slot = slots_[static_cast<std::size_t>(node)];
      if (slot == kAbsent) {
        slot = slot_count_++;
        missing.push_back(node);
      }
    }
    while (blocks_.size() * kBlockNodes < static_cast<std::size_t>(slot_count_)) {
      blocks_.push_back(std::make_unique_for_overwrite<float[]>(kBlockNodes * record_floats_));
    }
    constexpr std::size_t kWorthThreads = 64;
#pragma omp parallel for schedule(static) if (missing.size() > kWorthThreads)
    for (std::size_t i = 0; i < missing.size(); ++i) {
      make(missing[i], const_cast<float*>((*this)[missing[i]]));
    }
  }

private:
  static constexpr std::size_t kBlockNodes = 256;
  static constexpr std::int32_t kAbsent = -1;

  std::size_t record_floats_;
  std::vector<std::int32_t> slots_; // per node
  std::int32_t slot_count_ = 0;
  std::vector<std::unique_ptr<float[]>> blocks_; // first touched by the thread that fills them
};

} // namespace phonomime
