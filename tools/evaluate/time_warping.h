// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace phonomime {

// How far time may be warped, either way (Sakoe-Chiba band).
inline constexpr double kWarpBand_s = 0.15;

// The synthesised curve warped onto the recorded one: per sample of the recording the mean of the
// synthesis' samples that dynamic time warping matches with it. Both curves are brought to mean 0
// and standard deviation 1 first; the path goes from the first pair to the last by steps (1, 0),
// (0, 1) and (1, 1) of equal weight, its cost is the sum of squared differences; ties go to (1, 1),
// then to (1, 0), a step in the recording. A pair of samples whose frames are more than
// `band_frames` apart is out of bounds. `frames`: the frame of each sample, increasing. The result
// is in the units of `synthesised`; a curve that does not vary is given back as it is.
std::vector<double> warp_onto(std::span<const double> recorded, std::span<const double> synthesised,
                              std::span<const std::int64_t> frames, std::int64_t band_frames);

} // namespace phonomime
