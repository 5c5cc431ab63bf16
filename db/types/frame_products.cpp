// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/frame_products.h"

#include "db/types/parallel_for.h"
#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace phonomime {

namespace {

// Channels lie in panels, a panel's frames one after the other: what a tile reads is contiguous.
constexpr Eigen::Index kPanel = 8;
constexpr Eigen::Index kTileRows = 4;       // half a panel by a panel fills the vector registers
constexpr Eigen::Index kFramesAtOnce = 256; // whose panels stay in the second-level cache
using Panels = std::vector<double>; // panel p, frame k, channel c: (p * #frames + k) * 8 + c
using Tile = std::array<double, kTileRows * kPanel>; // row by row

// tile += products of 4 channels from `a` with 8 from `b`.
PHONOMIME_DISPATCHED
void add_products(const double* a, const double* b, Eigen::Index frames, Tile& tile) {
  DoubleLanes low_sums[kTileRows], high_sums[kTileRows];
  for (std::size_t row = 0; row < kTileRows; ++row) {
    load(low_sums[row], tile.data() + row * kPanel);
    load(high_sums[row], tile.data() + row * kPanel + kDoubleLanes);
  }
  for (Eigen::Index k = 0; k < frames; ++k) {
    DoubleLanes low, high;
    load(low, b + k * kPanel);
    load(high, b + k * kPanel + kDoubleLanes);
    for (std::size_t row = 0; row < kTileRows; ++row) {
      const double value = a[k * kPanel + static_cast<Eigen::Index>(row)];
      low_sums[row] += value * low;
      high_sums[row] += value * high;
    }
  }
  for (std::size_t row = 0; row < kTileRows; ++row) {
    std::memcpy(tile.data() + row * kPanel, &low_sums[row], sizeof low_sums[row]);
    std::memcpy(tile.data() + row * kPanel + kDoubleLanes, &high_sums[row], sizeof high_sums[row]);
  }
}

Panels into_panels(const Eigen::Ref<const FrameMatrixD>& frames, Eigen::Index panels, int threads) {
  const Eigen::Index count = frames.rows();
  Panels packed(static_cast<std::size_t>(panels * count * kPanel), 0.0);
  parallel_for(panels, threads, [&](std::ptrdiff_t panel) {
    const Eigen::Index first = panel * kPanel;
    const Eigen::Index width = std::min(kPanel, frames.cols() - first);
    double* to = packed.data() + panel * count * kPanel;
    for (Eigen::Index k = 0; k < count; ++k) {
      for (Eigen::Index c = 0; c < width; ++c) {
        to[k * kPanel + c] = frames(k, first + c);
      }
    }
  });
  return packed;
}

} // namespace

Eigen::MatrixXd frame_products(const Eigen::Ref<const FrameMatrixD>& frames, int threads) {
  const Eigen::Index channels = frames.cols(), count = frames.rows();
  const Eigen::Index panels = (channels + kPanel - 1) / kPanel;
  const Panels packed = into_panels(frames, panels, threads);
  const auto at = [&](Eigen::Index panel, Eigen::Index frame) {
    return packed.data() + (panel * count + frame) * kPanel;
  };
  Eigen::MatrixXd products(channels, channels);
  // Each pass of the loop writes its own rows, and their mirror images.
  parallel_for(panels, threads, [&](std::ptrdiff_t panel) {
    std::vector<std::array<Tile, 2>> tiles(static_cast<std::size_t>(panels - panel)); // zeros
    for (Eigen::Index first = 0; first < count; first += kFramesAtOnce) {
      const Eigen::Index some = std::min(kFramesAtOnce, count - first);
      for (std::size_t i = 0; i < tiles.size(); ++i) {
        const double* other = at(panel + static_cast<Eigen::Index>(i), first);
        add_products(at(panel, first), other, some, tiles[i][0]);
        add_products(at(panel, first) + kTileRows, other, some, tiles[i][1]);
      }
    }
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const Eigen::Index column = (panel + static_cast<Eigen::Index>(i)) * kPanel;
      for (Eigen::Index r = 0; r < std::min(kPanel, channels - panel * kPanel); ++r) {
        for (Eigen::Index c = 0; c < std::min(kPanel, channels - column); ++c) {
          const double sum = tiles[i][static_cast<std::size_t>(r / kTileRows)]
                                  [static_cast<std::size_t>(r % kTileRows * kPanel + c)];
          products(panel * kPanel + r, column + c) = sum;
          products(column + c, panel * kPanel + r) = sum;
        }
      }
    }
  });
  return products;
}

} // namespace phonomime
