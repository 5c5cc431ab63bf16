// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/point_scan.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <cstddef>
#include <cstring>
#include <numeric>

namespace phonomime {

namespace {

// Dimensions after which a panel that is out of reach already is left.
constexpr std::size_t kDimensionsOfLook = 6;

using LaneBits = std::int32_t __attribute__((vector_size(sizeof(FloatLanes))));

inline bool any(const LaneBits& bits) {
  std::array<std::uint64_t, sizeof bits / sizeof(std::uint64_t)> words;
  std::memcpy(words.data(), &bits, sizeof bits);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

// Adds the squared differences along dimensions [from, to) of 4 queries to a panel's 8 points.
inline void add_squares(FloatLanes* sums, const float* queries, const float* panel,
                        std::size_t from, std::size_t to) {
  for (std::size_t d = from; d < to; ++d) {
    FloatLanes point;
    load(point, panel + d * kFloatLanes);
    for (std::size_t q = 0; q < 4; ++q) {
      const FloatLanes difference = point - queries[d * 4 + q];
      sums[q] += difference * difference;
    }
  }
}

// The first panel in [panel, end) with a point within reach of some query; its distances (4 by 8).
PHONOMIME_DISPATCHED std::size_t first_within(const float* queries, const float* reach_sq,
                                              const float* panels, std::size_t dimensions,
                                              std::size_t panel, std::size_t end,
                                              float* distances_sq) {
  const std::size_t look = dimensions < kDimensionsOfLook ? dimensions : kDimensionsOfLook;
  for (; panel < end; ++panel) {
    const float* points = panels + panel * dimensions * kFloatLanes;
    FloatLanes sums[4] = {};
    add_squares(sums, queries, points, 0, look);
    LaneBits within = {};
    for (std::size_t q = 0; q < 4; ++q) {
      within |= sums[q] <= reach_sq[q];
    }
    if (!any(within)) {
      continue;
    }
    add_squares(sums, queries, points, look, dimensions);
    within = LaneBits{};
    for (std::size_t q = 0; q < 4; ++q) {
      within |= sums[q] <= reach_sq[q];
    }
    if (any(within)) {
      std::memcpy(distances_sq, sums, sizeof sums);
      break;
    }
  }
  return panel;
}

} // namespace

PointScan::PointScan(const FrameMatrix& points) : points_(points) {
  const auto dimensions = static_cast<std::size_t>(points.cols());
  const auto count = static_cast<std::size_t>(points.rows());
  std::vector<float> width(dimensions, 0.0F);
  for (std::size_t d = 0; d < dimensions && count > 0; ++d) {
    const auto column = points.col(static_cast<Eigen::Index>(d));
    width[d] = column.maxCoeff() - column.minCoeff();
  }
  axes_.resize(dimensions);
  std::iota(axes_.begin(), axes_.end(), Eigen::Index{0});
  std::stable_sort(axes_.begin(), axes_.end(), [&](Eigen::Index a, Eigen::Index b) {
    return width[static_cast<std::size_t>(a)] > width[static_cast<std::size_t>(b)];
  });
  panel_count_ = (count + kLanes - 1) / kLanes;
  // Lanes without a point are out of every reach.
  panels_.assign(panel_count_ * dimensions * kLanes, std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < count; ++i) {
    float* panel = panels_.data() + i / kLanes * dimensions * kLanes + i % kLanes;
    for (std::size_t d = 0; d < dimensions; ++d) {
      panel[d * kLanes] = points(static_cast<Eigen::Index>(i), axes_[d]);
    }
  }
}

void PointScan::set_query(Tile& tile, std::size_t slot, std::int32_t query) const {
  for (std::size_t d = 0; d < axes_.size(); ++d) {
    tile.queries[d * kTile + slot] = points_(query, axes_[d]);
  }
}

PointScan::Hit PointScan::first_hit(const Tile& tile, std::size_t panel, std::size_t end) const {
  std::array<float, kTile * kLanes> distances_sq;
  Hit hit;
  hit.panel = first_within(tile.queries.data(), tile.reach_sq.data(), panels_.data(), axes_.size(),
                           panel, end, distances_sq.data());
  if (hit.panel < end) {
    for (std::size_t slot = 0; slot < kTile; ++slot) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        hit.within[slot][lane] = distances_sq[slot * kLanes + lane] <= tile.reach_sq[slot];
      }
    }
  }
  return hit;
}

float PointScan::reach_sq(double distance_sq) const {
  // Differences, squares and sums of d terms are each off by at most half a unit of the last place:
  // d + 3 of them, and one more to come here. Squares that vanish cost under the smallest normal.
  const double units = static_cast<double>(axes_.size()) + 8.0;
  return static_cast<float>(distance_sq * (1.0 + units * std::numeric_limits<float>::epsilon()) +
                            1e-37);
}

double PointScan::distance_sq(std::int32_t a, std::int32_t b) const {
  double sum = 0.0;
  for (Eigen::Index d = 0; d < points_.cols(); ++d) {
    const double difference =
        static_cast<double>(points_(a, d)) - static_cast<double>(points_(b, d));
    sum += difference * difference;
  }
  return sum;
}

} // namespace phonomime
