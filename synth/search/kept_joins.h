// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_frontier.h"

#include <cstddef>
#include <span>
#include <vector>

namespace phonomime {

// The least joins of nodes with those of the neighbouring step, several of each node and a bound of
// all others: what the least value + TC is after values have risen takes a few additions then, and
// no look at the others (docs/search_bounds.md).
class KeptJoins {
public:
  // For `nodes` nodes, by the values of these neighbours (ascending). Nothing is kept yet.
  void reset(std::size_t nodes, std::span<const NodeIndex> neighbours,
             std::span<const double> values);

  // Of the node at `place`, found with the present values. Different places may be filled at once.
  void keep(std::size_t place, const JoinFrontier::LeastJoins& least);

  // Takes over the neighbours' present values. No value may have fallen; there may be other
  // neighbours than before.
  void renew(std::span<const NodeIndex> neighbours, std::span<const double> values);

  struct Least {
    double value = 0.0;       // at most value + TC of any neighbour that is kept
    NodeIndex node = kNoNode; // whose that is
    double rest = 0.0;        // at most value + TC of any neighbour that is not
  };
  // `value_of`: the present values per node of the table, infinite for those that are no neighbour.
  Least least(std::size_t place, std::span<const double> value_of) const;

  // The joins kept of a node by the present values, up to `limit`.
  JoinFrontier::LeastJoins joins(std::size_t place, std::span<const double> value_of,
                                 double limit) const;

private:
  static constexpr std::size_t kEach = JoinFrontier::LeastJoins::kMost;

  std::vector<NodeIndex> neighbours_;
  std::vector<double> values_;   // of the neighbours
  std::vector<NodeIndex> nodes_; // kEach per node
  std::vector<float> joins_;     // of those, at most TC; infinite where there are not so many
  std::vector<double> rest_;     // per node
};

} // namespace phonomime
