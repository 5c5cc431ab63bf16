// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_frontier.h"

#include <algorithm>
#include <array>

namespace phonomime {

JoinFrontier::JoinFrontier(Side side, const JoinCost& cost, const JoinBound& bound,
                           std::span<const NodeIndex> nodes, std::span<const double> values)
    : side_(side), cost_(cost), bound_(bound), place_(cost.table().nodes.size(), -1) {
  candidates_.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    candidates_.push_back({values[i], nodes[i]});
  }
  std::ranges::sort(candidates_, [](const Candidate& a, const Candidate& b) {
    return a.value != b.value ? a.value < b.value : a.node < b.node;
  });
  ends_.reserve(candidates_.size() * bound_.end_floats());
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const NodeIndex node = candidates_[i].node;
    place_[static_cast<std::size_t>(node)] = static_cast<std::int32_t>(i);
    const float* end = side_ == Side::earlier ? bound_.last_end(node) : bound_.first_end(node);
    ends_.insert(ends_.end(), end, end + bound_.end_floats());
  }
}

NodeIndex JoinFrontier::captured_partner(NodeIndex node) const {
  return side_ == Side::earlier ? info(node).predecessor : info(node).successor;
}

double JoinFrontier::transition(NodeIndex candidate, NodeIndex node) const {
  return side_ == Side::earlier ? cost_.transition(candidate, node)
                                : cost_.transition(node, candidate);
}

double JoinFrontier::bounded_transition(const Candidate& c, NodeIndex node, float gaps) const {
  const NodeIndex from = side_ == Side::earlier ? c.node : node;
  const NodeIndex to = side_ == Side::earlier ? node : c.node;
  const NodeIndex before = info(to).predecessor;
  if (before == from) {
    return 0.0;
  }
  if (before == kNoNode) {
    return cost_.weights().alpha1 * cost_.weights().pnt;
  }
  const double join = static_cast<double>(gaps);
  return info(from).viseme == info(before).viseme ? join : join + cost_.weights().pnt;
}

JoinFrontier::Best JoinFrontier::best_join(NodeIndex node, double penalty, double limit,
                                           Counts& counts) const {
  Best best;
  const auto consider = [&](const Candidate& c, double transition_cost) {
    const double value = (c.value + transition_cost) + penalty;
    if (value <= limit && (value < best.value || (value == best.value && c.node < best.node))) {
      best = {value, c.node};
    }
  };
  const NodeIndex partner = captured_partner(node);
  if (partner != kNoNode && place_[static_cast<std::size_t>(partner)] >= 0) {
    consider(candidates_[static_cast<std::size_t>(place_[static_cast<std::size_t>(partner)])], 0.0);
  }
  struct Bounded {
    double value;
    std::size_t candidate;
  };
  const float* end = side_ == Side::earlier ? bound_.first_end(node) : bound_.last_end(node);
  std::array<float, kBlock> gaps;
  std::array<Bounded, kBlock> survivors;
  for (std::size_t begin = 0; begin < candidates_.size(); begin += kBlock) {
    if (candidates_[begin].value + penalty > std::min(best.value, limit)) {
      break;
    }
    const std::size_t count = std::min(kBlock, candidates_.size() - begin);
    bound_.bound(end,
                 std::span(ends_).subspan(begin * bound_.end_floats(), count * bound_.end_floats()),
                 std::span(gaps).first(count));
    counts.bounds += static_cast<std::int64_t>(count);
    std::size_t survivor_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Candidate& c = candidates_[begin + i];
      const double value = (c.value + bounded_transition(c, node, gaps[i])) + penalty;
      if (c.node != partner && value <= std::min(best.value, limit)) {
        survivors[survivor_count++] = {value, begin + i};
      }
    }
    std::sort(survivors.begin(), survivors.begin() + static_cast<std::ptrdiff_t>(survivor_count),
              [](const Bounded& a, const Bounded& b) { return a.value < b.value; });
    for (std::size_t i = 0; i < survivor_count && survivors[i].value <= best.value; ++i) {
      const Candidate& c = candidates_[survivors[i].candidate];
      ++counts.transitions;
      consider(c, transition(c.node, node));
    }
  }
  return best;
}

double JoinFrontier::bound_join(NodeIndex node, double limit, Counts& counts) const {
  double best = limit;
  bool found = false;
  const NodeIndex partner = captured_partner(node);
  if (partner != kNoNode && place_[static_cast<std::size_t>(partner)] >= 0) {
    const auto place = static_cast<std::size_t>(place_[static_cast<std::size_t>(partner)]);
    if (candidates_[place].value <= best) {
      best = candidates_[place].value;
      found = true;
    }
  }
  const float* end = side_ == Side::earlier ? bound_.first_end(node) : bound_.last_end(node);
  std::array<float, kBlock> gaps;
  for (std::size_t begin = 0; begin < candidates_.size() && candidates_[begin].value <= best;
       begin += kBlock) {
    const std::size_t count = std::min(kBlock, candidates_.size() - begin);
    bound_.bound(end,
                 std::span(ends_).subspan(begin * bound_.end_floats(), count * bound_.end_floats()),
                 std::span(gaps).first(count));
    counts.bounds += static_cast<std::int64_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Candidate& c = candidates_[begin + i];
      const double value = c.value + bounded_transition(c, node, gaps[i]);
      if (value <= best) {
        best = value;
        found = true;
      }
    }
  }
  return found ? best : kInfinity;
}

} // namespace phonomime
