// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/map_picture.h"
#include "tools/app/phoneme_maps.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

struct MapImageOptions {
  std::filesystem::path database;
  std::string speaker; // may be empty where there is only one
  std::string phoneme;
  std::vector<std::filesystem::path> outputs; // .png, .svg
  bool pca = false;                           // the PCA map
  bool trajectories = true;                   // of all nodes, not only of highlighted ones
  bool suspects = false, pruned = false;      // highlighted
  std::optional<double> relative_time;        // 0 to 1: time-correct frames
  std::string previous, next;                 // triphone context: both or neither
  std::filesystem::path path;                 // a synthesis result: its nodes are highlighted
  std::vector<std::string> chosen;            // keys of nodes that are, too
  std::map<std::string, Colour> palette;      // by emotion
  MapPictureOptions picture;
  int threads = 0; // 0: as many as there are
};

struct MapImageReport {
  StoredMapRecord record;             // of the maps that are shown
  MapState state = MapState::missing; // unless fresh, they were made for the picture
  // How many nodes are highlighted.
  std::int64_t context_correct = 0, chosen = 0, suspect = 0, pruned = 0;
};

// Writes all outputs or none. Throws UsageError, InputError, IoError and Interrupted.
MapImageReport draw_map_image(const MapImageOptions& options, const Progress& progress);

} // namespace phonomime
