// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <span>

namespace phonomime {

// The smoothing spline of E16, its last term read as the integral of |g''|^2 with time in frames:
// replaces f_1..f_n by the values g_1..g_n of the function g that minimises
//     sum_i W_i (g_i - f_i)^2 + integral of g''(t)^2 dt,
// a natural cubic spline with its knots at the frames, each column by itself. Found by Reinsch's
// algorithm (Green & Silverman 1994, section 2.3.3): one pentadiagonal system of order n - 2.
// Straight lines, and fewer than three frames, stay as they are.
// `frames`: n by #dimensions, one frame apart, replaced. `weights`: n, all > 0.
// Throws InternalError where the sizes differ or a weight is not positive.
void fit_smoothing_spline(Eigen::Ref<FrameMatrixD> frames, std::span<const double> weights);

} // namespace phonomime
