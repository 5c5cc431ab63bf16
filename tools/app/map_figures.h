// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/map_quality.h"
#include "tools/app/phoneme_maps.h"

#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

struct MapFiguresOptions {
  std::filesystem::path database;
  std::string speaker;               // may be empty where there is only one
  std::vector<std::string> phonemes; // empty: all that have nodes
  int threads = 0;                   // 0: as many as there are
};

// How well the two maps of a phoneme show its frames.
struct MapFigures {
  StoredMapRecord record;
  MapState state = MapState::missing; // unless fresh, they were made for this
  int emotions = 0;                   // that its frames show
  MapQuality isomap, pca;
};

// Measures both maps of every phoneme. Throws UsageError, InputError, IoError and Interrupted.
std::vector<MapFigures> measure_phoneme_maps(const MapFiguresOptions& options,
                                             const Progress& progress);

// A measure of a map: a value of either map, nothing where it has no meaning.
struct MapMeasure {
  const char* id;
  const char* name;
  bool more_is_better;
  std::optional<double> (*of)(const MapFigures& figures, bool of_pca);
};
const std::vector<MapMeasure>& map_measures();

// Which of the two maps a measure finds better, over all phonemes where both have it.
struct MapContest {
  int isomap_better = 0, pca_better = 0, equal = 0; // phonemes
  double isomap_mean = 0.0, pca_mean = 0.0;         // by frames
  int phonemes() const { return isomap_better + pca_better + equal; }
};
MapContest compare_maps(const std::vector<MapFigures>& figures, const MapMeasure& measure);

} // namespace phonomime
