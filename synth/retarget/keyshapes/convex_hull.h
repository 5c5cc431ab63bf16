// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <vector>

namespace phonomime {

// The corners of the convex hull of points in the plane (#points by at least 2 columns, the first
// two count), by CGAL with exact predicates: counter-clockwise from the leftmost (the lower of
// those). Points on an edge are no corners; of points at one place the first stands for all.
std::vector<Eigen::Index> convex_hull(const FrameMatrixD& points);

} // namespace phonomime
