// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <Eigen/Core>

namespace phonomime {

// Places on a map: #points by 2, x to the right and y up, in the unit of the points' distances.
using MapPlaces = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

// The points' two directions of largest variance, from their mean (E section IV's PCA map), with
// the sides that orient_axes gives them. `points`: #points by #dimensions.
MapPlaces pca_places(const FrameMatrix& points);

// Moves places to their mean and turns them to their principal axes, the wider first.
void centre_and_align(MapPlaces& places);

// Mirrors axes so that maps do not flip between runs, nor against each other: along each axis the
// dimension of the points that goes with it most (largest covariance, ties to the first) increases.
// `points`: #points by #dimensions, row i at places' row i.
void orient_axes(MapPlaces& places, const FrameMatrix& points);

} // namespace phonomime
