// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "isomap/neighbour_graph.h"

#include <cstdint>
#include <span>

#include <Eigen/Core>

namespace phonomime {

// Row-major: a row is one source's distances.
using DistanceMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Lengths of the shortest paths along the graph's edges from each source: #sources by #points,
// infinity where there is no path. The same bytes for any number of threads (0: as many as there
// are): a length is the least of all left-to-right sums of edges from its source, by whatever way
// it was found. Throws Interrupted.
DistanceMatrix geodesic_distances(const NeighbourGraph& graph,
                                  std::span<const std::int32_t> sources, int threads,
                                  const Progress& progress = {});

} // namespace phonomime
