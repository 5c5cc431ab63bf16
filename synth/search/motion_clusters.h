// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <vector>

namespace phonomime {

// Channel groups that move alike, put together: what the lower bounds of joins stand on
// (docs/search_bounds.md).
//
// With E_k the rows of `basis` (#channels by #dimensions: the PCA's, weighted) for group k and Q_k
// any orthogonal matrix, |E_k d| = |Q_k E_k d|, so that by the triangle inequality
//     sum over a cluster of |E_k d|  >=  |(sum over the cluster of Q_k E_k) d|  =  |P d|.
// Q_k turns the group's motion towards that of its cluster (orthogonal Procrustes on the rows
// scaled by the standard deviations of the coefficients), so that little is lost.
//
// Returns one P per cluster, #channels_per_group by #dimensions; at most `count`, at least one.
// The same table gives the same clusters.
std::vector<Eigen::MatrixXd> cluster_channel_groups(const MotionTable& table,
                                                    const Eigen::MatrixXd& basis, int count);

} // namespace phonomime
