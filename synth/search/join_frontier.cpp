// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_frontier.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

// Leaves room for the rounding of a sum that is associated in another way.
constexpr double kBelow = 1.0 - 1e-12;

const std::vector<EndTree::Entry> kNone;

NodeEnd candidate_end(JoinFrontier::Side side) {
  return side == JoinFrontier::Side::earlier ? NodeEnd::last : NodeEnd::first;
}

} // namespace

JoinFrontier::JoinFrontier(Side side, const JoinKernels& kernels, std::span<const NodeIndex> nodes,
                           std::span<const double> values)
    : side_(side), kernels_(kernels) {
  const NodeEnd end = candidate_end(side);
  const std::vector<std::int32_t>& rank = kernels_.sketch.rank(end);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (values[i] == kInfinity) {
      continue;
    }
    least_value_ = std::min(least_value_, values[i]);
    const EndTree::Entry entry{nodes[i], values[i]};
    by_node_.push_back(entry);
    const bool starts = side == Side::later && info(nodes[i]).predecessor == kNoNode;
    if (side == Side::earlier || starts) {
      starts_.push_back(entry);
    }
    if (!starts) {
      candidates_.push_back(entry);
    }
  }
  std::ranges::sort(starts_, [](const EndTree::Entry& a, const EndTree::Entry& b) {
    return a.value != b.value ? a.value < b.value : a.node < b.node;
  });
  std::ranges::sort(candidates_, {}, [&](const EndTree::Entry& entry) {
    return rank[static_cast<std::size_t>(entry.node)];
  });
  tree_ = EndTree(kernels_.sketch, table(), end, candidates_);
}

NodeIndex JoinFrontier::captured_partner(NodeIndex node) const {
  return side_ == Side::earlier ? info(node).predecessor : info(node).successor;
}

const EndTree::Entry* JoinFrontier::find(NodeIndex node) const {
  const auto place = std::ranges::lower_bound(by_node_, node, {}, &EndTree::Entry::node);
  return place != by_node_.end() && place->node == node ? &*place : nullptr;
}

template <typename Limit, typename Known, typename Join>
void JoinFrontier::visit_joins(NodeIndex node, Counts& counts, const Limit& limit,
                               const Known& known, const Join& join) const {
  const CostWeights& weights = kernels_.cost.weights();
  const NodeIndex partner = captured_partner(node);
  if (const EndTree::Entry* captured = find(partner)) { // rule 1
    known(*captured, 0.0);
  }
  const bool node_starts = side_ == Side::earlier && info(node).predecessor == kNoNode;
  const double start_cost = weights.alpha1 * weights.pnt; // rule 4
  for (const EndTree::Entry& entry : node_starts || side_ == Side::later ? starts_ : kNone) {
    if (entry.value + start_cost > limit() || !known(entry, start_cost)) {
      break;
    }
  }
  if (node_starts) {
    return;
  }
  const NodeEnd end = side_ == Side::earlier ? NodeEnd::first : NodeEnd::last;
  const std::int32_t viseme = join_viseme(table(), end, node);
  counts.bounds += tree_.search(kernels_.sketch.end(end, node), viseme, weights.pnt, limit,
                                [&](std::size_t place, std::int32_t own_viseme, double bound) {
                                  const EndTree::Entry& entry = candidates_[place];
                                  if (entry.node != partner) {
                                    join(entry, own_viseme == viseme ? 0.0 : weights.pnt, bound);
                                  }
                                });
}

JoinFrontier::Best JoinFrontier::best_join(NodeIndex node, double penalty, double limit,
                                           Counts& counts) const {
  Best best;
  const auto total = [&](const EndTree::Entry& entry, double transition) {
    return (entry.value + transition) + penalty;
  };
  const auto worth_it = [&](double value) { return value <= std::min(best.value, limit); };
  const auto consider = [&](const EndTree::Entry& entry, double transition) {
    const double value = total(entry, transition);
    if (worth_it(value) && (value < best.value || entry.node < best.node)) {
      best = {value, entry.node};
    }
    return true; // another of the same cost may have a smaller index
  };
  // The least value + TC whose total could round to the best one or less.
  const auto tree_limit = [&] {
    const double most = std::min(best.value, limit);
    return (most - penalty) + 1e-12 * (std::abs(most) + penalty);
  };
  visit_joins(node, counts, tree_limit, consider,
              [&](const EndTree::Entry& entry, double other_viseme, double) {
                const auto [from, to] = in_time(entry.node, node);
                const double enough = tree_limit() - entry.value - other_viseme;
                if (!worth_it(total(entry, kernels_.bound.gaps(from, to, enough) + other_viseme)) ||
                    !worth_it(total(entry, kernels_.cost.gaps_floor(from, to) + other_viseme))) {
                  return;
                }
                ++counts.transitions;
                const double gaps = kernels_.cost.gaps(from, to);
                if (worth_it(total(entry, gaps + other_viseme))) {
                  const double join = kernels_.cost.smoothing(from, to) + gaps;
                  consider(entry, join + other_viseme);
                }
              });
  return best;
}

void JoinFrontier::bound_join(NodeIndex node, Tightness tightness,
                              std::span<const LeastJoins::Join> hints, LeastJoins& least,
                              Counts& counts) const {
  const auto consider_join = [&](const EndTree::Entry& entry, double other_viseme) {
    const auto [from, to] = in_time(entry.node, node);
    const double room = least.limit() - entry.value - other_viseme;
    if (kernels_.bound.gaps(from, to, room) > room) {
      return;
    }
    const double gaps = kernels_.cost.gaps_floor(from, to);
    if (gaps <= room) {
      ++counts.transitions;
      const double smoothing = kernels_.cost.smoothing_up_to(room - gaps, from, to) * kBelow;
      least.consider(entry, smoothing + gaps + other_viseme);
    }
  };
  const NodeEnd end = side_ == Side::earlier ? NodeEnd::first : NodeEnd::last;
  const NodeIndex partner = captured_partner(node);
  std::array<NodeIndex, 2 * LeastJoins::kMost> tried;
  std::size_t tried_count = 0;
  for (const LeastJoins::Join& known : least.joins()) {
    tried[tried_count++] = known.node;
  }
  const auto is_new = [&](NodeIndex candidate) {
    const auto end_of_tried = tried.begin() + static_cast<std::ptrdiff_t>(tried_count);
    return std::find(tried.begin(), end_of_tried, candidate) == end_of_tried;
  };
  if (tightness == Tightness::tight && least.joins().empty() &&
      join_viseme(table(), end, node) >= 0) {
    for (const LeastJoins::Join& hint : hints) {
      const std::int32_t viseme = join_viseme(table(), candidate_end(side_), hint.node);
      if (hint.node != partner && viseme >= 0) {
        const bool same = join_viseme(table(), end, node) == viseme;
        consider_join(*find(hint.node), same ? 0.0 : kernels_.cost.weights().pnt);
        tried[tried_count++] = hint.node;
      }
    }
  }
  visit_joins(
      node, counts, [&] { return least.limit(); },
      [&](const EndTree::Entry& entry, double transition) {
        if (is_new(entry.node)) {
          least.consider(entry, transition);
        }
        return true;
      },
      [&](const EndTree::Entry& entry, double other_viseme, double bound) {
        if (!is_new(entry.node)) {
          return;
        }
        if (tightness == Tightness::rough) {
          least.consider(entry, std::max(0.0, (bound - entry.value) * kBelow));
        } else {
          consider_join(entry, other_viseme);
        }
      });
}

} // namespace phonomime
