// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/marker_spread.h"

#include "db/types/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace phonomime {
namespace {

constexpr int kNearest = 3;
constexpr double kSmallestWeight = 1e-12;

// For each marker, the vertices of the markers whose cells touch its own by an edge.
std::vector<std::set<int>> touching_cells(const EdgeGraph& graph,
                                          std::span<const int> marker_vertices) {
  std::vector<int> sources;
  std::vector<int> cell(static_cast<std::size_t>(graph.vertex_count()), -1); // a marker's index
  for (std::size_t k = 0; k < marker_vertices.size(); ++k) {
    if (marker_vertices[k] >= 0) {
      sources.push_back(marker_vertices[k]);
      cell[static_cast<std::size_t>(marker_vertices[k])] = static_cast<int>(k);
    }
  }
  DijkstraWalk walk(graph, sources);
  for (auto step = walk.next(); step.vertex >= 0; step = walk.next()) {
    if (walk.predecessor(step.vertex) >= 0) {
      cell[static_cast<std::size_t>(step.vertex)] =
          cell[static_cast<std::size_t>(walk.predecessor(step.vertex))];
    }
  }
  std::vector<std::set<int>> touching(marker_vertices.size());
  for (int a = 0; a < graph.vertex_count(); ++a) {
    const int own = cell[static_cast<std::size_t>(a)];
    for (const auto& [b, unused] : graph.neighbours(a)) {
      const int other = cell[static_cast<std::size_t>(b)];
      if (own >= 0 && other >= 0 && own != other) {
        touching[static_cast<std::size_t>(own)].insert(
            marker_vertices[static_cast<std::size_t>(other)]);
      }
    }
  }
  return touching;
}

struct Sigmas {
  double near = 0.0; // 0 = no other marker can be reached
  double neighbour = 0.0;
};

Sigmas sigmas_of(const EdgeGraph& graph, int source, const std::vector<char>& is_marker,
                 const std::set<int>& neighbours) {
  DijkstraWalk walk(graph, source);
  double near_sum = 0.0;
  double neighbour_sum = 0.0;
  int near = 0;
  std::size_t met = 0;
  for (auto step = walk.next(); step.vertex >= 0 && (near < kNearest || met < neighbours.size());
       step = walk.next()) {
    if (step.vertex == source || is_marker[static_cast<std::size_t>(step.vertex)] == 0) {
      continue;
    }
    if (near < kNearest) {
      near_sum += step.distance;
      ++near;
    }
    if (neighbours.contains(step.vertex)) {
      neighbour_sum += step.distance;
      ++met;
    }
  }
  return {near > 0 ? 0.5 * near_sum / near : 0.0,
          met > 0 ? 0.5 * neighbour_sum / static_cast<double>(met) : 0.0};
}

void fill_gaps_with_median(std::vector<double>& sigma) {
  std::vector<double> known;
  std::ranges::copy_if(sigma, std::back_inserter(known), [](double s) { return s > 0.0; });
  double median = 1.0; // no marker reaches another: each moves the vertices within a few mm
  if (!known.empty()) {
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::ranges::nth_element(known, middle);
    median = *middle;
  }
  std::ranges::replace(sigma, 0.0, median);
}

// #markers by #markers: the rows of the markers' own vertices, empty for one that has none.
SpreadWeights rows_at(const SpreadWeights& weights, std::span<const int> marker_vertices) {
  const auto count = static_cast<Eigen::Index>(marker_vertices.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < count; ++k) {
    const int vertex = marker_vertices[static_cast<std::size_t>(k)];
    if (vertex >= 0) {
      for (SpreadWeights::InnerIterator entry(weights, vertex); entry; ++entry) {
        entries.emplace_back(k, static_cast<int>(entry.col()), entry.value());
      }
    }
  }
  SpreadWeights rows(count, count);
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

} // namespace

MarkerDistances::MarkerDistances(const EdgeGraph& graph, std::span<const int> marker_vertices,
                                 int threads)
    : graph_(graph), marker_vertices_(marker_vertices.begin(), marker_vertices.end()),
      threads_(threads), near_sigma_(marker_vertices.size(), 0.0),
      neighbour_sigma_(marker_vertices.size(), 0.0) {
  std::vector<char> is_marker(static_cast<std::size_t>(graph.vertex_count()), 0);
  for (const int vertex : marker_vertices) {
    if (vertex >= 0) {
      is_marker[static_cast<std::size_t>(vertex)] = 1;
    }
  }
  const auto touching = touching_cells(graph, marker_vertices);
  parallel_for(std::ssize(marker_vertices), threads, [&](std::ptrdiff_t marker) {
    const auto k = static_cast<std::size_t>(marker);
    if (marker_vertices_[k] >= 0) {
      const Sigmas found = sigmas_of(graph_, marker_vertices_[k], is_marker, touching[k]);
      near_sigma_[k] = found.near;
      neighbour_sigma_[k] = found.neighbour;
    }
  });
  fill_gaps_with_median(near_sigma_);
  fill_gaps_with_median(neighbour_sigma_);
}

SpreadWeights MarkerDistances::weights(std::span<const double> sigma_mm) const {
  const int count = static_cast<int>(marker_vertices_.size());
  std::vector<std::vector<Eigen::Triplet<double>>> columns(marker_vertices_.size());
  parallel_for(count, threads_, [&](std::ptrdiff_t marker) {
    const auto k = static_cast<std::size_t>(marker);
    if (marker_vertices_[k] < 0) {
      return;
    }
    DijkstraWalk walk(graph_, marker_vertices_[k]);
    for (auto step = walk.next(); step.vertex >= 0; step = walk.next()) {
      const double ratio = step.distance / sigma_mm[k];
      const double weight = std::exp(-0.5 * ratio * ratio); // E14
      if (weight < kSmallestWeight) {
        return;
      }
      columns[k].emplace_back(step.vertex, static_cast<int>(marker), weight);
    }
  });
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(graph_.vertex_count());
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& column : columns) {
    for (const auto& entry : column) {
      sums(entry.row()) += entry.value();
      entries.push_back(entry);
    }
  }
  for (auto& entry : entries) { // E15
    entry = {entry.row(), entry.col(), entry.value() / std::max(sums(entry.row()), std::exp(-2.0))};
  }
  SpreadWeights weights(graph_.vertex_count(), count);
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

SpreadWeights spread_weights(const EdgeGraph& graph, std::span<const int> marker_vertices,
                             const SpreadOptions& options) {
  const MarkerDistances distances(graph, marker_vertices, options.threads);
  if (options.sigma_mm > 0.0) {
    return distances.weights(std::vector<double>(marker_vertices.size(), options.sigma_mm));
  }
  std::vector<double> finest = distances.near_sigma();
  for (double& sigma : finest) {
    sigma *= 0.5;
  }
  const auto count = static_cast<Eigen::Index>(marker_vertices.size());
  SpreadWeights weights(graph.vertex_count(), count);
  SpreadWeights left(count, count); // of the markers' motions, at their own vertices
  left.setIdentity();
  for (const auto& sigma : {distances.neighbour_sigma(), distances.near_sigma(), finest}) {
    const SpreadWeights correction = distances.weights(sigma) * left;
    weights = SpreadWeights(weights + correction);
    left = SpreadWeights(left - rows_at(correction, marker_vertices));
  }
  return weights;
}

} // namespace phonomime
