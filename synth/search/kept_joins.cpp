// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/kept_joins.h"

#include "synth/search/end_tree.h"

#include <algorithm>
#include <iterator>

namespace phonomime {

namespace {

constexpr double kInfinity = JoinFrontier::kInfinity;
constexpr std::size_t kWorthThreads = 2048;

// What a candidate has now, and by how much that is more than before.
struct Rise {
  double value;
  double rise;
};

// The candidates that rose less than any of a smaller value, by value.
std::vector<Rise> least_rises(std::span<const double> before, std::span<const double> now) {
  double least = kInfinity;
  double most = 0.0;
  for (const double value : now) {
    least = std::min(least, value);
    most = std::max(most, value < kInfinity ? value : 0.0);
  }
  // By parts of the values' range, so that few are left to sort.
  std::array<double, 256> rises;
  rises.fill(kInfinity);
  const double scale = static_cast<double>(rises.size() - 1) / std::max(most - least, 1e-300);
  const auto part = [&](double value) {
    return std::min(rises.size() - 1, static_cast<std::size_t>((value - least) * scale));
  };
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] < kInfinity) {
      double& rise = rises[part(now[i])];
      rise = std::min(rise, now[i] - before[i]);
    }
  }
  for (std::size_t i = 1; i < rises.size(); ++i) {
    rises[i] = std::min(rises[i], rises[i - 1]); // of all up to here
  }
  std::vector<Rise> found;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] < kInfinity) {
      const std::size_t own = part(now[i]);
      if (own == 0 || now[i] - before[i] < rises[own - 1]) {
        found.push_back({now[i], now[i] - before[i]});
      }
    }
  }
  std::ranges::sort(found, {}, &Rise::value);
  for (std::size_t i = 1; i < found.size(); ++i) {
    found[i].rise = std::min(found[i].rise, found[i - 1].rise);
  }
  return found;
}

} // namespace

void KeptJoins::reset(std::size_t nodes) {
  nodes_.assign(nodes, {});
  for (Node& node : nodes_) {
    node.joins.fill(kNoJoin);
  }
}

void KeptJoins::keep(std::size_t place, const JoinFrontier::LeastJoins& least) {
  Node& node = nodes_[place];
  node.rest = least.limit();
  node.joins.fill(kNoJoin);
  for (std::size_t k = 0; k < least.joins().size(); ++k) {
    node.candidates[k] = static_cast<std::uint32_t>(least.joins()[k].place);
    node.joins[k] = float_below(least.joins()[k].join);
  }
}

void KeptJoins::renew(std::span<const double> before, std::span<const double> now) {
  const std::vector<Rise> rises = least_rises(before, now);
  // A candidate that is not kept had at least `rest`; now it has at least rest + its rise, and at
  // least its own value.
#pragma omp parallel for schedule(static) if (nodes_.size() > kWorthThreads)
  for (std::size_t place = 0; place < nodes_.size(); ++place) {
    double& rest = nodes_[place].rest;
    const auto beyond =
        std::ranges::partition_point(rises, [&](const Rise& r) { return r.value < rest + r.rise; });
    const double risen = beyond == rises.begin() ? kInfinity : rest + std::prev(beyond)->rise;
    rest = std::min(risen, beyond == rises.end() ? kInfinity : beyond->value);
  }
}

KeptJoins::Least KeptJoins::least(std::size_t place, const JoinFrontier& frontier) const {
  const Node& node = nodes_[place];
  Least least;
  least.rest = node.rest;
  for (std::size_t k = 0; k < kEach && node.joins[k] != kNoJoin; ++k) {
    const JoinFrontier::Candidate candidate = frontier.candidate(node.candidates[k]);
    const double value = candidate.value + static_cast<double>(node.joins[k]);
    if (value < least.value) {
      least.value = value;
      least.node = candidate.node;
    }
  }
  return least;
}

JoinFrontier::LeastJoins KeptJoins::joins(std::size_t place, const JoinFrontier& frontier,
                                          double limit) const {
  const Node& node = nodes_[place];
  JoinFrontier::LeastJoins joins(kEach, limit);
  for (std::size_t k = 0; k < kEach && node.joins[k] != kNoJoin; ++k) {
    const JoinFrontier::Candidate candidate = frontier.candidate(node.candidates[k]);
    if (candidate.value < kInfinity) {
      joins.consider(candidate, static_cast<double>(node.joins[k]));
    }
  }
  return joins;
}

} // namespace phonomime
