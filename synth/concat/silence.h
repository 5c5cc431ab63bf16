// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace phonomime {

// How the frames of /pau/ are made from their borders (E section VII-B).
enum class SilenceFill {
  linear, // straight from border to border
  cosine, // half a cosine wave: sets out and arrives at rest
  cubic   // leaves and arrives with the borders' own velocities
};

inline constexpr std::array<std::string_view, 3> kSilenceFillNames = {"linear", "cosine", "cubic"};

struct SilenceOptions {
  SilenceFill fill = SilenceFill::linear;
  bool rest_at_ends = true;   // else a /pau/ at an end holds its one border
  double rest_within_s = 0.2; // time in which an end reaches the reference pose
};

// Fills every frame that is not shown, in place.
//
// Between two shown frames the fill runs from one to the other. A velocity (cubic) is the one-sided
// difference of the border frame and the shown frame beside it, 0 where there is none; it is
// carried for at most 0.2 s into the silence, so that a long pause cannot throw the face off: up to
// there the fill is the cubic Hermite curve, beyond it a cubic spline with a knot where each
// velocity has faded; C1 throughout.
//
// At either end of the motion the fill reaches `rest` within rest_within_s of its border and stays
// there. A shorter silence gets there by its outer end; one shorter than half of rest_within_s
// would have to jump, and goes only as far as it would get in that half. Where nothing at all is
// shown, everything rests.
//
// `frames`: #frames by #dimensions. `shown`: #frames, 1 where a motion node gave the frame. `rest`:
// #dimensions, the reference pose. `rate_hz`: frames a second.
void fill_silence(FrameMatrixD& frames, const std::vector<std::uint8_t>& shown,
                  const Eigen::RowVectorXd& rest, double rate_hz, const SilenceOptions& options);

} // namespace phonomime
