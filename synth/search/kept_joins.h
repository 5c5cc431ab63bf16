// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_frontier.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace phonomime {

// The least joins of a step's nodes with those of the neighbouring step, some of each node and a
// bound of all others: what the least value + TC is after values have risen takes a few additions
// then, and no look at the others (docs/search_bounds.md).
class KeptJoins {
public:
  // For `nodes` nodes. Nothing is known yet.
  void reset(std::size_t nodes);

  // Of the node at `place`. Different places may be filled at once.
  void keep(std::size_t place, const JoinFrontier::LeastJoins& least);

  // After the values of the frontier's candidates have risen.
  void renew(std::span<const double> before, std::span<const double> now);

  struct Least {
    double value = JoinFrontier::kInfinity; // at most value + TC of any candidate that is kept
    NodeIndex node = kNoNode;               // whose that is
    double rest = 0.0;                      // at most value + TC of any candidate that is not
  };
  // By the frontier's values now, which may have risen since the look.
  Least least(std::size_t place, const JoinFrontier& frontier) const;

  // The joins kept of a node, by the frontier's values now, up to `limit`.
  JoinFrontier::LeastJoins joins(std::size_t place, const JoinFrontier& frontier,
                                 double limit) const;

private:
  static constexpr std::size_t kEach = JoinFrontier::LeastJoins::kMost;
  static constexpr float kNoJoin = std::numeric_limits<float>::infinity();

  struct Node {
    double rest = 0.0;
    std::array<std::uint32_t, kEach> candidates = {}; // their places in the frontier
    std::array<float, kEach> joins;                   // at most TC; kNoJoin where there is none
  };
  std::vector<Node> nodes_;
};

} // namespace phonomime
