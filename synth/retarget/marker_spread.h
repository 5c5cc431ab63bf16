// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/edge_graph.h"

#include <span>
#include <vector>

#include <Eigen/SparseCore>

namespace phonomime {

// How E14-E15 spread the markers' motion over the mesh (DESIGN section 7).
struct SpreadOptions {
  double sigma_mm = 0.0; // one sigma for all markers and one pass of E15; 0 = as below
  int threads = 1;       // 0: as many as there are; the result does not depend on it
};

// #vertices by #markers: row i times the markers' motions is VtxMotion_i.
using SpreadWeights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// Distances over mesh edges from every marker, as far as they are asked for. Markers with vertex -1
// are not on this mesh and reach nothing.
class MarkerDistances {
public:
  // `marker_vertices`: #markers, into the graph's vertices, each at most once.
  MarkerDistances(const EdgeGraph& graph, std::span<const int> marker_vertices, int threads);

  // #markers each, in mm. A marker that reaches no other has the median of those that do.
  // Half the mean distance to the 3 nearest markers: how close the markers stand.
  const std::vector<double>& near_sigma() const { return near_sigma_; }
  // Half the mean distance to the markers whose cells (the vertices nearest to a marker) touch this
  // one's: wide enough that no gap is left between lip and chin, where no marker stands.
  const std::vector<double>& neighbour_sigma() const { return neighbour_sigma_; }

  // One pass of E15 with E14's weights, C = 1 (it cancels), and their sum kept at least w0 =
  // exp(-2), so that motion fades out where no marker is near:
  //   w(k, i) = exp(-MeshDist(k, i)^2 / (2 sigma_k^2))
  //   VtxMotion_i = sum_k w(k, i) MrkMotion_k / max(sum_k w(k, i), w0)
  // `sigma_mm`: #markers, > 0. Weights under 1e-12 count as none.
  SpreadWeights weights(std::span<const double> sigma_mm) const;

private:
  const EdgeGraph& graph_;
  std::vector<int> marker_vertices_;
  int threads_ = 1;
  std::vector<double> near_sigma_;
  std::vector<double> neighbour_sigma_;
};

// The weights that a face is moved with. With options.sigma_mm: one pass of E15. Without: three
// passes, each E15 of what those before leave of the markers' motions at the markers' own vertices,
// with neighbour_sigma, with near_sigma and with half of near_sigma:
//   W <- W + Wp L,  L <- L - (Wp L at the markers),  from W = 0, L = I
// Over grid_s1, one pass with near_sigma keeps 0.98 of the aperture (canonical and ict) but leaves
// the skin between lip and chin at rest, so that it folds when the mouth opens; one pass with
// neighbour_sigma folds nothing but keeps 0.91 and 0.82. The passes together keep 1.00 and fold
// nothing, and the aperture survives where markers are few too.
SpreadWeights spread_weights(const EdgeGraph& graph, std::span<const int> marker_vertices,
                             const SpreadOptions& options);

} // namespace phonomime
