// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "isomap/map_places.h"
#include "isomap/neighbour_graph.h"

#include <cstdint>
#include <vector>

namespace phonomime {

// What becomes of points that no path of neighbours leads to.
enum class DisconnectedParts {
  join,        // they are joined by the shortest edges there are
  keep_largest // only the largest part is on the map
};

struct IsomapOptions {
  int neighbours = 12; // k, E section IV
  DisconnectedParts disconnected = DisconnectedParts::join;
  int largest_exact = 5000; // points; more of them are placed by landmarks
  int landmarks = 500;
  std::uint64_t seed = 1; // of the choice of landmarks
  int threads = 0;        // 0: as many as there are

  // Throws InputError that names the value: neighbours < 1, landmarks < 3, largest_exact < 1,
  // threads < 0.
  void validate() const;
};

// Both maps of a cluster of points, and what there is to know about them.
struct ClusterMaps {
  std::vector<std::int32_t> kept; // points on the maps, ascending; all of them unless keep_largest
  MapPlaces isomap;               // #kept by 2
  MapPlaces pca;                  // #kept by 2
  // Of both against the same geodesic distances.
  double isomap_residual_variance = 0.0;
  double pca_residual_variance = 0.0;

  int neighbours = 0; // of each point: k, or all others where there are fewer
  int landmarks = 0;  // 0: every point is one
  std::vector<std::int32_t> component_sizes; // of the neighbour graph as it was, largest first
  std::vector<PointPair> joined;             // edges that join them, points as given
  std::vector<std::int32_t> far_points; // kept points, as given: their k-th neighbour is more than
                                        // kFarFactor times as far as that of the median point
};
inline constexpr double kFarFactor = 8.0;

// The phoneme-Isomap of a cluster (E section IV; Tenenbaum, de Silva, Langford 2000): neighbour
// graph, geodesics, classical scaling; above `largest_exact` points with landmarks (de Silva,
// Tenenbaum 2003). k is never changed. Every cluster has a result: no points give an empty map, one
// point or points that are all alike are at (0, 0), points on a line have y = 0. `points`: #points
// by #dimensions, finite, the unit of distance its own. Axes are oriented (orient_axes), so that
// the same points give the same bytes, at any number of threads. Throws InputError (options),
// InternalError (points that are not finite), Interrupted.
ClusterMaps build_maps(const FrameMatrix& points, const IsomapOptions& options,
                       const Progress& progress = {});

} // namespace phonomime
