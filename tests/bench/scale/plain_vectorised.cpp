// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/plain_vectorised.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"
#include "synth/search/step_costs.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace phonomime::bench {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kAtOnce = 4 * kDoubleLanes;

// The least of a[i] + b[i]; `size` is a multiple of kAtOnce.
PHONOMIME_DISPATCHED
double least_sum(const double* a, const double* b, std::size_t size) {
  std::array<DoubleLanes, 4> least;
  least.fill(DoubleLanes{kInfinity, kInfinity, kInfinity, kInfinity});
  for (std::size_t i = 0; i < size; i += kAtOnce) {
    for (std::size_t part = 0; part < 4; ++part) {
      DoubleLanes left;
      DoubleLanes right;
      load(left, a + i + part * kDoubleLanes);
      load(right, b + i + part * kDoubleLanes);
      const DoubleLanes sum = left + right;
      least[part] = sum < least[part] ? sum : least[part];
    }
  }
  double result = kInfinity;
  for (const DoubleLanes& lanes : least) {
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      result = std::min(result, lanes[lane]);
    }
  }
  return result;
}

} // namespace

PlainVectorised::PlainVectorised(const MotionTable& table, const CostWeights& weights)
    : table_(table), cost_(table, weights),
      stride_((table.nodes.size() + kAtOnce - 1) / kAtOnce * kAtOnce),
      transitions_(stride_ * table.nodes.size()) {
  std::vector<NodeIndex> all(table.nodes.size());
  std::iota(all.begin(), all.end(), 0);
  cost_.ensure(all);
#pragma omp parallel for schedule(dynamic, 8)
  for (std::size_t to = 0; to < all.size(); ++to) {
    for (std::size_t from = 0; from < all.size(); ++from) {
      transitions_[to * stride_ + from] =
          cost_.transition(static_cast<NodeIndex>(from), static_cast<NodeIndex>(to));
    }
  }
}

NodePath PlainVectorised::solve(std::span<const SearchStep> steps) const {
  const std::size_t nodes = table_.nodes.size();
  std::vector<std::vector<double>> phi(steps.size(), std::vector<double>(stride_, kInfinity));
  const auto own = [&](std::size_t step, std::size_t node) {
    return is_allowed(steps[step], static_cast<NodeIndex>(node))
               ? step_penalty(steps[step], table_.nodes[node], cost_.weights())
               : kInfinity;
  };
  for (std::size_t t = 0; t < steps.size(); ++t) {
#pragma omp parallel for schedule(static)
    for (std::size_t node = 0; node < nodes; ++node) {
      const double reached =
          t == 0 ? 0.0 : least_sum(phi[t - 1].data(), into(node), stride_); // phi + TC
      phi[t][node] = t == 0 ? own(t, node) : reached + own(t, node);
    }
  }
  NodePath path;
  path.nodes.resize(steps.size());
  const auto last = std::ranges::min_element(phi.back()); // the first of equal ones
  path.cost = *last;
  auto node = static_cast<std::size_t>(last - phi.back().begin());
  for (std::size_t t = steps.size(); t-- > 0;) {
    path.nodes[t] = static_cast<NodeIndex>(node);
    if (t > 0) {
      const double reached = phi[t][node];
      const double penalty = own(t, node);
      const double* join = into(node);
      std::size_t from = 0;
      while ((phi[t - 1][from] + join[from]) + penalty != reached) {
        ++from;
      }
      node = from;
    }
  }
  return path;
}

} // namespace phonomime::bench
