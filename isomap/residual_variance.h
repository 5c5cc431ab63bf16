// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/geodesics.h"
#include "isomap/map_places.h"

#include <cstdint>
#include <span>

namespace phonomime {

// What a map leaves unexplained (Tenenbaum, de Silva, Langford 2000): 1 - R^2, R the linear
// correlation of distances on the map with geodesic distances over all pairs of a source and a
// point, that of a point with itself too. 0 to 1; 0 where no two points differ at all, 1 where one
// of the two does not vary. `distances`: #sources by #points, finite; `sources` into the points;
// `places`: #points by 2. The same bytes for any number of threads.
double residual_variance(const DistanceMatrix& distances, std::span<const std::int32_t> sources,
                         const MapPlaces& places, int threads);

} // namespace phonomime
