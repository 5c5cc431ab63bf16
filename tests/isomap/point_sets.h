// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "isomap/map_places.h"

#include <random>

namespace phonomime::test {

// #points by #dimensions, each coordinate uniform in [0, size).
FrameMatrix uniform_points(std::mt19937& random, int count, int dimensions, double size = 1.0);

// Points as a phoneme cluster has them: `nodes` short smooth trajectories in a curved sheet of two
// dimensions that lies in `dimensions`, with a little noise.
FrameMatrix trajectory_points(std::mt19937& random, int nodes, int frames_a_node, int dimensions);

// A sheet rolled up in space, and where its points are on the sheet: arc length and height.
struct SwissRoll {
  FrameMatrix points; // #points by 3
  MapPlaces sheet;    // #points by 2
};
SwissRoll swiss_roll(std::mt19937& random, int count);

// Places in the plane as points in `dimensions`, turned and moved by chance.
FrameMatrix lay_into_space(std::mt19937& random, const MapPlaces& places, int dimensions);

// Largest distance of a point of `a` from its own in `b` after the rigid motion or reflection that
// brings a nearest to b (Kabsch), over b's root mean square distance from its mean.
double misfit(const MapPlaces& a, const MapPlaces& b);

} // namespace phonomime::test
