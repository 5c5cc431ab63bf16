// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "synth/retarget/mapping/marker_shapes.h"

#include <Eigen/Core>
#include <Eigen/QR>

namespace phonomime {

// X's baseline, the equation-solving method: B = B0 + sum over i of w_i B_i (X7) over the markers,
// solved for w by least squares (of the shortest w where several do) and clamped to [0, 1]. Before,
// the source's motion is scaled on each axis by how far apart the face's markers stand on it, over
// how far the source's do. X measures that between landmarks that are picked by hand; here it is
// the root mean square over all pairs of markers.
class EquationSolver {
public:
  explicit EquationSolver(MarkerShapes shapes);

  const MarkerShapes& shapes() const { return shapes_; }
  const Eigen::Vector3d& proportions() const { return proportions_; } // face over source

  // `channels`: #frames by #channels, mm, head motion off; NaN = missing, those rows are left out.
  // #frames by #shapes.
  FrameMatrixD weights(const FrameMatrixD& channels) const;

private:
  Eigen::VectorXd solve_with_gaps(const Eigen::VectorXd& target) const;

  MarkerShapes shapes_;
  Eigen::Vector3d proportions_ = Eigen::Vector3d::Ones();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver_;
};

} // namespace phonomime
