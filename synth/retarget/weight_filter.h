// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

namespace phonomime {

// Weights over time, smoothed without delay (T section 3.2): from none (0, the very same numbers)
// to strong. Each frame becomes the mean of its neighbours under a bell of standard deviation
// `width_s` (0.01: hardly visible; 0.1: no syllable is left), cut at four of them and at the ends
// of the motion. Means: weights stay within the bounds that they had, constants stay exact.
// Half the power is left at 0.1325 / width_s Hz.
//
// `weights`: #frames by #shapes at `rate_hz`. Throws UsageError for a width that is negative or not
// finite.
FrameMatrixD filter_weights(const FrameMatrixD& weights, double rate_hz, double width_s);

} // namespace phonomime
