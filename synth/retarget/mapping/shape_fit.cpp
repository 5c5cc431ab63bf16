// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/shape_fit.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace phonomime {
namespace {

// Channels of the inner lips' heights where both are on the face.
std::optional<std::pair<int, int>> lip_channels(const MarkerShapes& shapes, const Layout& layout) {
  if (layout.kind != LayoutKind::markers || layout.channel_count() != shapes.channel_count()) {
    throw InternalError({.what = "a layout that the face's markers do not belong to"});
  }
  const auto upper = layout.find_landmark("lip_upper_inner");
  const auto lower = layout.find_landmark("lip_lower_inner");
  const auto on_face = [&](int group) {
    return shapes.on_face[static_cast<std::size_t>(group)] != 0;
  };
  if (!upper || !lower || !on_face(*upper) || !on_face(*lower)) {
    return std::nullopt;
  }
  return std::pair(3 * *upper + 1, 3 * *lower + 1);
}

WeightSolver make_solver(const MarkerShapes& shapes, const std::optional<std::pair<int, int>>& lips,
                         const ShapeFitOptions& options) {
  const Eigen::Index rows = shapes.channel_count() + (lips ? 1 : 0);
  Eigen::MatrixXd system(rows, shapes.shape_count());
  Eigen::VectorXd row_weights = Eigen::VectorXd::Ones(rows);
  system.topRows(shapes.channel_count()) = shapes.offsets;
  for (std::size_t g = 0; g < shapes.on_face.size(); ++g) {
    if (shapes.on_face[g] == 0) {
      row_weights.segment<3>(3 * static_cast<Eigen::Index>(g)).setZero();
    }
  }
  if (lips) {
    system.bottomRows(1) = shapes.offsets.row(lips->first) - shapes.offsets.row(lips->second);
    row_weights(rows - 1) = options.opening;
  }
  return {std::move(system), row_weights, options.solve};
}

} // namespace

void ShapeFitOptions::validate() const {
  solve.validate();
  if (!(opening >= 0.0) || !std::isfinite(opening)) {
    throw UsageError({.what = "the opening of the lips cannot weigh that much in a fit",
                      .expected = "a number of at least 0",
                      .got = std::to_string(opening)});
  }
}

ShapeFit::ShapeFit(MarkerShapes shapes, const Layout& layout, const ShapeFitOptions& options)
    : shapes_(std::move(shapes)), lips_(lip_channels(shapes_, layout)),
      solver_(make_solver(shapes_, lips_, options)) {}

FrameMatrixD ShapeFit::weights(const FrameMatrixD& channels, WeightReport* report) const {
  if (channels.cols() != shapes_.channel_count()) {
    throw InternalError({.what = "motion of another layout than the face's markers",
                         .expected = std::to_string(shapes_.channel_count()),
                         .got = std::to_string(channels.cols())});
  }
  FrameMatrixD targets(channels.rows(), channels.cols() + (lips_ ? 1 : 0));
  targets.leftCols(channels.cols()) = channels.rowwise() - shapes_.reference.transpose();
  if (lips_) {
    const double rest = shapes_.rest(lips_->first) - shapes_.rest(lips_->second);
    for (Eigen::Index k = 0; k < channels.rows(); ++k) {
      const double opening = channels(k, lips_->first) - channels(k, lips_->second);
      targets(k, channels.cols()) = std::isnan(opening) ? opening : std::max(opening, 0.0) - rest;
    }
  }
  return solver_.solve(targets, report);
}

} // namespace phonomime
