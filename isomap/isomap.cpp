// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/isomap.h"

#include "db/types/errors.h"
#include "isomap/classical_scaling.h"
#include "isomap/landmarks.h"
#include "isomap/residual_variance.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace phonomime {

namespace {

void check_at_least(std::string_view name, long long value, long long least) {
  if (value < least) {
    throw InputError({.where = "Isomap options",
                      .what = std::string(name) + " is out of range",
                      .expected = "at least " + std::to_string(least),
                      .got = std::to_string(value)});
  }
}

// Points of `points` that are not in the largest component leave, those of the rest close ranks.
FrameMatrix keep_largest(const FrameMatrix& points, const Components& components,
                         ClusterMaps& maps) {
  std::erase_if(maps.kept, [&](std::int32_t i) {
    return components.of_point[static_cast<std::size_t>(i)] != 0;
  });
  FrameMatrix left(static_cast<Eigen::Index>(maps.kept.size()), points.cols());
  for (std::size_t i = 0; i < maps.kept.size(); ++i) {
    left.row(static_cast<Eigen::Index>(i)) = points.row(maps.kept[i]);
  }
  return left;
}

std::vector<std::int32_t> find_far_points(const Neighbours& neighbours, std::size_t point_count) {
  std::vector<std::int32_t> far;
  if (neighbours.count == 0) {
    return far;
  }
  std::vector<double> reach(point_count);
  for (std::size_t i = 0; i < point_count; ++i) {
    reach[i] = neighbours.distances_of(i).back();
  }
  std::vector<double> ordered = reach;
  const auto middle = ordered.begin() + static_cast<std::ptrdiff_t>(point_count / 2);
  std::nth_element(ordered.begin(), middle, ordered.end());
  for (std::size_t i = 0; i < point_count; ++i) {
    if (reach[i] > kFarFactor * *middle) {
      far.push_back(static_cast<std::int32_t>(i));
    }
  }
  return far;
}

// The connected graph of the points that are kept; `points` become those.
NeighbourGraph connected_graph(FrameMatrix& points, const IsomapOptions& options,
                               ClusterMaps& maps) {
  Neighbours neighbours = nearest_neighbours(points, options.neighbours, options.threads);
  NeighbourGraph graph(static_cast<std::int32_t>(points.rows()), neighbours);
  const Components components = find_components(graph);
  maps.component_sizes = components.sizes;
  if (components.sizes.size() > 1) {
    if (options.disconnected == DisconnectedParts::join) {
      maps.joined = joining_edges(points, components, options.threads);
      graph = NeighbourGraph(graph.point_count(), neighbours, maps.joined);
    } else {
      points = keep_largest(points, components, maps);
      neighbours = nearest_neighbours(points, options.neighbours, options.threads);
      graph = NeighbourGraph(static_cast<std::int32_t>(points.rows()), neighbours);
    }
  }
  maps.neighbours = neighbours.count;
  for (const std::int32_t i : find_far_points(neighbours, maps.kept.size())) {
    maps.far_points.push_back(maps.kept[static_cast<std::size_t>(i)]);
  }
  return graph;
}

} // namespace

void IsomapOptions::validate() const {
  check_at_least("neighbours", neighbours, 1);
  check_at_least("largest_exact", largest_exact, 1);
  check_at_least("landmarks", landmarks, 3);
  check_at_least("threads", threads, 0);
}

ClusterMaps build_maps(const FrameMatrix& points, const IsomapOptions& options,
                       const Progress& progress) {
  options.validate();
  if (!points.allFinite()) {
    throw InternalError({.where = "Isomap", .what = "a point is not finite"});
  }
  ClusterMaps maps;
  maps.kept.resize(static_cast<std::size_t>(points.rows()));
  std::iota(maps.kept.begin(), maps.kept.end(), 0);
  if (points.rows() == 0) {
    return maps;
  }
  progress.update("neighbours", 0, points.rows());
  FrameMatrix kept = points;
  const NeighbourGraph graph = connected_graph(kept, options, maps);
  progress.update("neighbours", points.rows(), points.rows());

  const bool exact = graph.point_count() <= options.largest_exact;
  const std::vector<std::int32_t> sources = choose_landmarks(
      graph.point_count(), exact ? graph.point_count() : options.landmarks, options.seed);
  const DistanceMatrix distances = geodesic_distances(graph, sources, options.threads, progress);
  if (exact) {
    maps.isomap = classical_scaling(distances, options.threads).places;
  } else {
    maps.landmarks = static_cast<int>(sources.size());
    DistanceMatrix between(distances.rows(), distances.rows());
    for (std::size_t l = 0; l < sources.size(); ++l) {
      between.col(static_cast<Eigen::Index>(l)) = distances.col(sources[l]);
    }
    maps.isomap = place_by_landmarks(distances, sources,
                                     classical_scaling(between, options.threads), options.threads);
  }
  orient_axes(maps.isomap, kept);
  maps.pca = pca_places(kept);
  maps.isomap_residual_variance =
      residual_variance(distances, sources, maps.isomap, options.threads);
  maps.pca_residual_variance = residual_variance(distances, sources, maps.pca, options.threads);
  return maps;
}

} // namespace phonomime
