// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_frontier.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace phonomime {

namespace {

// Leaves room for the rounding of a sum that is associated in another way.
constexpr double kBelow = 1.0 - 1e-12;

const std::vector<std::size_t> kNone;

NodeEnd candidate_end(JoinFrontier::Side side) {
  return side == JoinFrontier::Side::earlier ? NodeEnd::last : NodeEnd::first;
}

} // namespace

JoinFrontier::JoinFrontier(Side side, const JoinKernels& kernels, std::span<const NodeIndex> nodes)
    : side_(side), kernels_(kernels), nodes_(nodes.begin(), nodes.end()),
      values_(nodes.size(), kInfinity) {
  const NodeEnd end = candidate_end(side);
  const std::vector<std::int32_t>& rank = kernels_.sketch.rank(end);
  for (std::size_t place = 0; place < nodes_.size(); ++place) {
    const bool starts = side == Side::later && info(nodes_[place]).predecessor == kNoNode;
    if (side == Side::earlier || starts) {
      starts_.push_back(place);
    }
    if (!starts) {
      in_tree_.push_back(place);
    }
  }
  std::ranges::sort(in_tree_, {}, [&](std::size_t place) {
    return rank[static_cast<std::size_t>(nodes_[place])];
  });
  std::vector<NodeIndex> entries;
  entries.reserve(in_tree_.size());
  std::ranges::transform(in_tree_, std::back_inserter(entries),
                         [&](std::size_t place) { return nodes_[place]; });
  tree_ = EndTree(kernels_.sketch, table(), end, entries);
}

void JoinFrontier::set_values(std::vector<double> values) {
  values_ = std::move(values);
  std::ranges::sort(starts_, [&](std::size_t a, std::size_t b) {
    return values_[a] != values_[b] ? values_[a] < values_[b] : a < b;
  });
  std::vector<double> in_tree;
  in_tree.reserve(in_tree_.size());
  std::ranges::transform(in_tree_, std::back_inserter(in_tree),
                         [&](std::size_t place) { return values_[place]; });
  tree_.set_values(in_tree);
}

NodeIndex JoinFrontier::captured_partner(NodeIndex node) const {
  return side_ == Side::earlier ? info(node).predecessor : info(node).successor;
}

std::optional<JoinFrontier::Candidate> JoinFrontier::find(NodeIndex node) const {
  const auto found = std::ranges::lower_bound(nodes_, node);
  const auto place = static_cast<std::size_t>(found - nodes_.begin());
  return found != nodes_.end() && *found == node && values_[place] < kInfinity
             ? std::optional(candidate(place))
             : std::nullopt;
}

template <typename Limit, typename Known, typename Join>
void JoinFrontier::visit_joins(NodeIndex node, Counts& counts, const Limit& limit,
                               const Known& known, const Join& join) const {
  const CostWeights& weights = kernels_.cost.weights();
  const NodeIndex partner = captured_partner(node);
  if (const std::optional<Candidate> captured = find(partner)) { // rule 1
    known(*captured, 0.0);
  }
  const bool node_starts = side_ == Side::earlier && info(node).predecessor == kNoNode;
  const double start_cost = weights.alpha1 * weights.pnt; // rule 4
  for (const std::size_t place : node_starts || side_ == Side::later ? starts_ : kNone) {
    if (values_[place] == kInfinity || values_[place] + start_cost > limit() ||
        !known(candidate(place), start_cost)) {
      break;
    }
  }
  if (node_starts) {
    return;
  }
  const NodeEnd end = side_ == Side::earlier ? NodeEnd::first : NodeEnd::last;
  const std::int32_t viseme = join_viseme(table(), end, node);
  counts.bounds +=
      tree_.search(kernels_.sketch.end(end, node), viseme, weights.pnt, limit,
                   [&](std::size_t entry, std::int32_t own_viseme, double bound) {
                     const std::size_t place = in_tree_[entry];
                     if (nodes_[place] != partner) {
                       join(candidate(place), own_viseme == viseme ? 0.0 : weights.pnt, bound);
                     }
                   });
}

JoinFrontier::Best JoinFrontier::best_join(NodeIndex node, double penalty, double limit,
                                           Counts& counts) const {
  Best best;
  const auto total = [&](const Candidate& candidate, double transition) {
    return (candidate.value + transition) + penalty;
  };
  const auto worth_it = [&](double value) { return value <= std::min(best.value, limit); };
  const auto consider = [&](const Candidate& candidate, double transition) {
    const double value = total(candidate, transition);
    if (worth_it(value) && (value < best.value || candidate.node < best.node)) {
      best = {value, candidate.node};
    }
    return true; // another of the same cost may have a smaller index
  };
  // The least value + TC whose total could round to the best one or less.
  const auto tree_limit = [&] {
    const double most = std::min(best.value, limit);
    return (most - penalty) + 1e-12 * (std::abs(most) + penalty);
  };
  visit_joins(
      node, counts, tree_limit, consider,
      [&](const Candidate& candidate, double other_viseme, double) {
        const auto [from, to] = in_time(candidate.node, node);
        const double enough = tree_limit() - candidate.value - other_viseme;
        if (!worth_it(total(candidate, kernels_.bound.gaps(from, to, enough) + other_viseme)) ||
            !worth_it(total(candidate, kernels_.cost.gaps_floor(from, to) + other_viseme))) {
          return;
        }
        ++counts.transitions;
        const double gaps = kernels_.cost.gaps(from, to);
        if (worth_it(total(candidate, gaps + other_viseme))) {
          const double join = kernels_.cost.smoothing(from, to) + gaps;
          consider(candidate, join + other_viseme);
        }
      });
  return best;
}

void JoinFrontier::bound_join(NodeIndex node, Tightness tightness,
                              std::span<const LeastJoins::Join> hints, LeastJoins& least,
                              Counts& counts) const {
  const auto consider_join = [&](const Candidate& candidate, double other_viseme) {
    const auto [from, to] = in_time(candidate.node, node);
    const double room = least.limit() - candidate.value - other_viseme;
    if (kernels_.bound.gaps(from, to, room) > room) {
      return;
    }
    const double gaps = kernels_.cost.gaps_floor(from, to);
    if (gaps <= room) {
      ++counts.transitions;
      const double smoothing = kernels_.cost.smoothing_floor(room - gaps, from, to) * kBelow;
      least.consider(candidate, smoothing + gaps + other_viseme);
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
        consider_join(candidate(hint.place), same ? 0.0 : kernels_.cost.weights().pnt);
        tried[tried_count++] = hint.node;
      }
    }
  }
  visit_joins(
      node, counts, [&] { return least.limit(); },
      [&](const Candidate& candidate, double transition) {
        if (is_new(candidate.node)) {
          least.consider(candidate, transition);
        }
        return true;
      },
      [&](const Candidate& candidate, double other_viseme, double bound) {
        if (!is_new(candidate.node)) {
          return;
        }
        if (tightness == Tightness::rough) {
          least.consider(candidate, std::max(0.0, (bound - candidate.value) * kBelow));
        } else {
          consider_join(candidate, other_viseme);
        }
      });
}

} // namespace phonomime
