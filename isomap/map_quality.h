// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "isomap/map_places.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace phonomime {

struct MapQualityOptions {
  int neighbours = 12;
  int largest_sample = 4000; // points; of more, so many are looked at (choose_landmarks)
  std::uint64_t seed = 1;    // of that choice
  int threads = 0;           // 0: as many as there are
};

// How a map shows its points. A measure is nothing where it has no meaning.
struct MapQuality {
  // Mean share of a point's nearest neighbours on the map that have its label, and what it would be
  // if neighbours were drawn by lot. Neighbours of the point's own group are passed over: the
  // frames of one recording lie side by side on any map. Nothing without two labels.
  std::optional<double> purity, purity_by_lot;
  // Mean silhouette of the labels on the map (Rousseeuw 1987), -1 to 1. Nothing without two labels.
  std::optional<double> silhouette;
  // Share of truth in the map's neighbourhoods, and share of the points' neighbourhoods that the
  // map keeps (Venna, Kaski 2001), 0 to 1. Nothing with fewer than 2 * neighbours + 1 points.
  std::optional<double> trustworthiness, continuity;
};

// `points`: #points by #dimensions; `places`: #points by 2, row i for points' row i; `labels`
// (emotions) and `groups` (motion nodes): #points each. Equal distances are in order of index. The
// same bytes for any number of threads. Throws InternalError where the sizes differ.
MapQuality measure_map(const FrameMatrix& points, const MapPlaces& places,
                       std::span<const std::int32_t> labels, std::span<const std::int32_t> groups,
                       const MapQualityOptions& options = {});

} // namespace phonomime
