// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

namespace phonomime {

// The PCA basis (#channels by #dimensions) with the rows of each channel group times the group's
// weight in E8 and E9: 1 for the lips, CostWeights::off_lips for the others. Norms of what it makes
// of a difference of coefficients are the weighted ones. A layout without lips weighs all by 1.
Eigen::MatrixXd weighted_basis(const MotionTable& table, const CostWeights& weights);

} // namespace phonomime
