// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <span>

namespace phonomime {

struct BlendOptions {
  double liveliness = 0.5;     // 0: the mean as it is; 1: all the energy of the motions in it
  double cut_off_s = 0.03;     // deviation of the gaussian between slow and fast motion
  double expected_share = 0.5; // of the motion that the words let expect, where it is known
};

// The mean of several motions of the same words, with a share of what the words let expect, made as
// lively as they are (docs/cost.md).
//
// Chance differences cancel in a mean, and with them part of what all of them do: it is flatter and
// slower than each. The mean is parted into its pose over time, slow and fast motion (a gaussian
// over time, held at the ends), and each of the latter two is multiplied by
//     1 + liveliness (sqrt(mean of the part's energy in the motions / in their mean) - 1),
// energy the sum of squares over frames, but by 2 at most. Each coefficient of the slow motion has
// a gain of its own: how far each of them moves is what an emotion is recognised by, and the less
// they have to do with the phonemes, the more they lose. The fast motion has one for all
// coefficients. `motions`: at least one, all #frames by #coefficients, of one stretch of speech.
// `expected`: the same, or without rows where nothing is expected. One motion comes back as it is,
// and so do, to rounding, motions that are all alike where nothing is expected.
FrameMatrixD blend_motions(std::span<const FrameMatrixD> motions, const FrameMatrixD& expected,
                           double rate_hz, const BlendOptions& options = {});

} // namespace phonomime
