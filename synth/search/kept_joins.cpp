// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/kept_joins.h"

#include "synth/search/end_tree.h"

#include <algorithm>
#include <limits>

namespace phonomime {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kWorthThreads = 2048;

} // namespace

void KeptJoins::reset(std::size_t nodes, std::span<const NodeIndex> neighbours,
                      std::span<const double> values) {
  neighbours_.assign(neighbours.begin(), neighbours.end());
  values_.assign(values.begin(), values.end());
  nodes_.assign(nodes * kEach, 0);
  joins_.assign(nodes * kEach, std::numeric_limits<float>::infinity());
  rest_.assign(nodes, 0.0);
}

void KeptJoins::keep(std::size_t place, const JoinFrontier::LeastJoins& least) {
  const std::span<const JoinFrontier::LeastJoins::Join> joins = least.joins();
  for (std::size_t k = 0; k < kEach; ++k) {
    const bool known = k < joins.size();
    nodes_[place * kEach + k] = known ? joins[k].node : 0;
    joins_[place * kEach + k] =
        known ? float_below(joins[k].join) : std::numeric_limits<float>::infinity();
  }
  rest_[place] = least.limit();
}

void KeptJoins::renew(std::span<const NodeIndex> neighbours, std::span<const double> values) {
  // What a neighbour has now, and by how much that is more than before.
  struct Rise {
    double value;
    double rise;
  };
  std::vector<Rise> rises;
  rises.reserve(neighbours.size());
  std::size_t before = 0;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (values[i] == kInfinity) {
      continue;
    }
    while (before < neighbours_.size() && neighbours_[before] < neighbours[i]) {
      ++before;
    }
    const bool known = before < neighbours_.size() && neighbours_[before] == neighbours[i];
    rises.push_back({values[i], known ? values[i] - values_[before] : -kInfinity});
  }
  std::ranges::sort(rises, {}, &Rise::value);
  for (std::size_t i = 1; i < rises.size(); ++i) {
    rises[i].rise = std::min(rises[i].rise, rises[i - 1].rise); // of all up to here
  }
  // A neighbour that is not kept had at least `rest`; now it has at least rest + its rise, and at
  // least its own value.
#pragma omp parallel for schedule(static) if (rest_.size() > kWorthThreads)
  for (std::size_t place = 0; place < rest_.size(); ++place) {
    const double rest = rest_[place];
    const auto beyond =
        std::ranges::partition_point(rises, [&](const Rise& r) { return r.value < rest + r.rise; });
    const double risen = beyond == rises.begin() ? kInfinity : rest + std::prev(beyond)->rise;
    rest_[place] = std::min(risen, beyond == rises.end() ? kInfinity : beyond->value);
  }
  neighbours_.assign(neighbours.begin(), neighbours.end());
  values_.assign(values.begin(), values.end());
}

KeptJoins::Least KeptJoins::least(std::size_t place, std::span<const double> value_of) const {
  Least least{kInfinity, kNoNode, rest_[place]};
  for (std::size_t k = place * kEach; k < (place + 1) * kEach; ++k) {
    const double value =
        value_of[static_cast<std::size_t>(nodes_[k])] + static_cast<double>(joins_[k]);
    if (value < least.value) {
      least.value = value;
      least.node = nodes_[k];
    }
  }
  return least;
}

JoinFrontier::LeastJoins KeptJoins::joins(std::size_t place, std::span<const double> value_of,
                                          double limit) const {
  JoinFrontier::LeastJoins joins(kEach, limit);
  for (std::size_t k = place * kEach; k < (place + 1) * kEach; ++k) {
    const double value = value_of[static_cast<std::size_t>(nodes_[k])];
    const auto join = static_cast<double>(joins_[k]);
    if (value + join < kInfinity) {
      joins.consider({nodes_[k], value}, join);
    }
  }
  return joins;
}

} // namespace phonomime
