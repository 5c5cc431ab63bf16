// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/map_view.h"
#include "isomap/palette.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

struct DensityOptions {
  double sigma_px = 9.0; // standard deviation of each frame's Gaussian
  double rho = 0.0;      // rho of E3, under 1; 0: such that half of all frames lie under kUsualInk
  int threads = 0;       // 0: as many as there are
};
inline constexpr double kUsualInk = 0.5;

// Three bytes a pixel, row by row from the top: red, green, blue (sRGB).
struct Raster {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> bytes;
};

// E3 with colours: each emotion's density is the sum over its frames of
// rho exp(-d^2 / (2 sigma^2)), d from the frame to the pixel's middle; their sum, clamped to 1, is
// how much ink there is, and its colour is the emotions' mean by their densities; it is laid over
// white. (Brightness as printed would add nothing for black.) A Gaussian ends at 4 sigma. `places`:
// #frames by 2; `emotion_of`: #frames, into `palette`. The same bytes for any number of threads.
// Throws InternalError where sizes or indices do not fit.
Raster draw_density(const MapPlaces& places, std::span<const std::int32_t> emotion_of,
                    std::span<const Colour> palette, const MapView& view,
                    const DensityOptions& options = {});

} // namespace phonomime
