// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/equation_solving.h"

#include "db/types/errors.h"

#include <cmath>
#include <utility>
#include <vector>

namespace phonomime {
namespace {

// Markers on the face, of #channels: #markers on it by 3.
Points present(const Eigen::VectorXd& channels, const std::vector<char>& on_face) {
  std::vector<Eigen::Index> groups;
  for (std::size_t g = 0; g < on_face.size(); ++g) {
    if (on_face[g] != 0) {
      groups.push_back(static_cast<Eigen::Index>(g));
    }
  }
  return Eigen::Map<const Points>(channels.data(), channels.size() / 3, 3)(groups, Eigen::all);
}

// Per axis, up to a factor that all sets of as many points share.
Eigen::Vector3d distances(const Points& points) {
  return (points.rowwise() - points.colwise().mean()).colwise().norm().transpose();
}

} // namespace

EquationSolver::EquationSolver(MarkerShapes shapes)
    : shapes_(std::move(shapes)), solver_(shapes_.offsets) {
  const Eigen::Vector3d face = distances(present(shapes_.rest, shapes_.on_face));
  const Eigen::Vector3d source = distances(present(shapes_.reference, shapes_.on_face));
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (face(axis) > 0.0 && source(axis) > 0.0) {
      proportions_(axis) = face(axis) / source(axis);
    }
  }
}

FrameMatrixD EquationSolver::weights(const FrameMatrixD& channels) const {
  if (channels.cols() != shapes_.channel_count()) {
    throw InternalError({.what = "motion of another layout than the face's markers",
                         .expected = std::to_string(shapes_.channel_count()),
                         .got = std::to_string(channels.cols())});
  }
  const Eigen::VectorXd scale = proportions_.replicate(shapes_.channel_count() / 3, 1);
  FrameMatrixD result(channels.rows(), shapes_.shape_count());
  for (Eigen::Index k = 0; k < channels.rows(); ++k) {
    const Eigen::VectorXd target =
        (channels.row(k).transpose() - shapes_.reference).cwiseProduct(scale);
    const Eigen::VectorXd solved =
        target.allFinite() ? Eigen::VectorXd(solver_.solve(target)) : solve_with_gaps(target);
    result.row(k) = solved.transpose().cwiseMax(0.0).cwiseMin(1.0);
  }
  return result;
}

Eigen::VectorXd EquationSolver::solve_with_gaps(const Eigen::VectorXd& target) const {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index c = 0; c < target.size(); ++c) {
    if (std::isfinite(target(c))) {
      rows.push_back(c);
    }
  }
  if (rows.empty()) {
    return Eigen::VectorXd::Zero(shapes_.shape_count());
  }
  const Eigen::MatrixXd offsets = shapes_.offsets(rows, Eigen::all);
  return offsets.completeOrthogonalDecomposition().solve(target(rows));
}

} // namespace phonomime
