// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "db/types/parallel_for.h"
#include "isomap/nearest_list.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace phonomime {

// Looks at every point for the nearest ones of many queries. Single precision with a stated margin
// throws out nearly all of them eight at a time; what is left is measured in double, so that the
// answer is exact and its order that of (squared distance, index). tests/bench/isomap_bench.cpp
// times it against a k-d tree.
class PointScan {
public:
  // `points` (#points by #dimensions, finite) must outlive the scan.
  explicit PointScan(const FrameMatrix& points);

  // For each query (into points) the `count` nearest of the other points j that
  // accept(query, j) lets through. #queries lists, shorter where fewer are let through.
  template <typename Accept>
  std::vector<NearestList> nearest(std::span<const std::int32_t> queries, int count, int threads,
                                   const Accept& accept) const;

private:
  static constexpr std::size_t kLanes = 8;          // points of a panel
  static constexpr std::size_t kTile = 4;           // queries looked at together
  static constexpr std::size_t kQueriesAtOnce = 64; // a thread's share
  static constexpr std::size_t kPanelsAtOnce = 128; // what a first-level cache can keep for them

  // The first panel in [panel, end) that holds a point within reach, and where.
  struct Hit {
    std::size_t panel = 0;
    std::array<std::array<bool, kLanes>, kTile> within = {}; // tile's queries by lanes
  };
  // A tile: #dimensions by kTile query coordinates, and how far (squared) each query looks.
  struct Tile {
    std::vector<float> queries;
    std::array<float, kTile> reach_sq = {};
  };
  Hit first_hit(const Tile& tile, std::size_t panel, std::size_t end) const;
  void set_query(Tile& tile, std::size_t slot, std::int32_t query) const;
  // No point that is as near as `distance_sq` is beyond this in single precision.
  float reach_sq(double distance_sq) const;
  double distance_sq(std::int32_t a, std::int32_t b) const;

  template <typename Accept>
  void scan_panels(Tile& tile, std::span<const std::int32_t> queries, std::span<NearestList> lists,
                   std::size_t panel, std::size_t end, const Accept& accept) const;
  template <typename Accept>
  void scan_queries(std::span<const std::int32_t> queries, std::span<NearestList> lists,
                    const Accept& accept) const;

  const FrameMatrix& points_;
  std::vector<Eigen::Index> axes_; // dimensions, the widest first: it decides soonest
  std::vector<float> panels_;      // panel by dimension by lane
  std::size_t panel_count_ = 0;
};

template <typename Accept>
void PointScan::scan_panels(Tile& tile, std::span<const std::int32_t> queries,
                            std::span<NearestList> lists, std::size_t panel, std::size_t end,
                            const Accept& accept) const {
  for (Hit hit = first_hit(tile, panel, end); hit.panel < end;
       hit = first_hit(tile, hit.panel + 1, end)) {
    for (std::size_t slot = 0; slot < queries.size(); ++slot) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto j = static_cast<std::int32_t>(hit.panel * kLanes + lane);
        if (hit.within[slot][lane] && j < points_.rows() && j != queries[slot] &&
            accept(queries[slot], j)) {
          lists[slot].offer({distance_sq(queries[slot], j), j});
        }
      }
      tile.reach_sq[slot] = reach_sq(lists[slot].reach_sq());
    }
  }
}

template <typename Accept>
void PointScan::scan_queries(std::span<const std::int32_t> queries, std::span<NearestList> lists,
                             const Accept& accept) const {
  // A query's own panels first: frames follow each other in time, so that its nearest are there.
  const std::size_t home =
      static_cast<std::size_t>(queries.front()) / kLanes / kPanelsAtOnce * kPanelsAtOnce;
  std::vector<Tile> tiles((queries.size() + kTile - 1) / kTile);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    tiles[t].queries.assign(axes_.size() * kTile, 0.0F);
    tiles[t].reach_sq.fill(-1.0F); // of no query: reaches nothing
    for (std::size_t i = t * kTile; i < std::min(queries.size(), (t + 1) * kTile); ++i) {
      set_query(tiles[t], i - t * kTile, queries[i]);
      tiles[t].reach_sq[i - t * kTile] = reach_sq(lists[i].reach_sq());
    }
  }
  const auto scan = [&](std::size_t first) {
    const std::size_t end = std::min(first + kPanelsAtOnce, panel_count_);
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      const std::size_t count = std::min(kTile, queries.size() - t * kTile);
      scan_panels(tiles[t], queries.subspan(t * kTile, count), lists.subspan(t * kTile, count),
                  first, end, accept);
    }
  };
  scan(home);
  for (std::size_t first = 0; first < panel_count_; first += kPanelsAtOnce) {
    if (first != home) {
      scan(first);
    }
  }
}

template <typename Accept>
std::vector<NearestList> PointScan::nearest(std::span<const std::int32_t> queries, int count,
                                            int threads, const Accept& accept) const {
  std::vector<NearestList> lists(queries.size(), NearestList(count));
  const std::size_t shares = (queries.size() + kQueriesAtOnce - 1) / kQueriesAtOnce;
  parallel_for(static_cast<std::ptrdiff_t>(shares), threads, [&](std::ptrdiff_t share) {
    const std::size_t first = static_cast<std::size_t>(share) * kQueriesAtOnce;
    const std::size_t size = std::min(kQueriesAtOnce, queries.size() - first);
    scan_queries(queries.subspan(first, size), std::span(lists).subspan(first, size), accept);
  });
  return lists;
}

} // namespace phonomime
