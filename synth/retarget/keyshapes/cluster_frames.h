// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <cstdint>
#include <vector>

namespace phonomime {

// K-means (Lloyd) with the seeding of k-means++ (Arthur & Vassilvitskii 2007): for each cluster the
// frame nearest its centre, the fullest cluster first. `points`: #frames by #dimensions. Fewer than
// `count` where there are not as many different points. The same seed gives the same frames.
std::vector<Eigen::Index> cluster_frames(const FrameMatrixD& points, int count, std::uint64_t seed);

} // namespace phonomime
