// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/classical_scaling.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// `count` of `point_count` points in increasing order, one by chance of each of `count` equal
// stretches: frames follow each other in time, so that every recording is there. All points where
// there are no more. The same for the same seed, on any machine.
std::vector<std::int32_t> choose_landmarks(std::int32_t point_count, std::int32_t count,
                                           std::uint64_t seed);

// Places for all points, given those of the landmarks (de Silva, Tenenbaum 2003, section 2.3):
// x = -1/2 L# (d - m), d a point's squared distances to the landmarks, m their means over the
// landmarks, the rows of L# the landmarks' coordinates over their eigenvalue. Landmarks come out
// where they are. Then moved and turned to the principal axes of all, as that section advises.
// `distances`: #landmarks by #points; `scaled`: of the landmarks alone.
MapPlaces place_by_landmarks(const DistanceMatrix& distances,
                             std::span<const std::int32_t> landmarks, const ScaledPlaces& scaled,
                             int threads);

} // namespace phonomime
