// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/geodesics.h"
#include "isomap/map_places.h"

#include <array>

namespace phonomime {

// Classical multidimensional scaling to two dimensions: places whose inner products come nearest to
// B = -1/2 J (D o D) J, J = I - 11'/n.
struct ScaledPlaces {
  MapPlaces places;                               // #points by 2, mean 0, axes' squared lengths:
  std::array<double, 2> eigenvalues = {0.0, 0.0}; // of B, largest first; 0 where there is none > 0
};

// `distances`: #points by #points, symmetric, finite, diagonal 0. The sign of an axis is arbitrary
// (see orient_axes). Points that are all alike are all at 0, points on a line have y = 0. The same
// bytes for any number of threads. Throws InternalError where the eigenvalues do not converge.
ScaledPlaces classical_scaling(const DistanceMatrix& distances, int threads);

} // namespace phonomime
