// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/phoneme_maps.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

struct MapPickOptions {
  std::filesystem::path database;
  std::string speaker; // may be empty where there is only one
  std::string phoneme;
  double x = 0.0, y = 0.0;                    // in the map's unit
  bool pca = false;                           // on the PCA map
  std::filesystem::path face;                 // for .glb
  std::vector<std::filesystem::path> outputs; // of the motion frame: .glb, .csv
  int threads = 0;                            // 0: as many as there are
};

// A recorded frame on the map.
struct PickedPoint {
  std::string node;       // key
  std::int32_t frame = 0; // in the node, counted from 0
  double relative_time = 0.0;
  std::string emotion;
  double x = 0.0, y = 0.0;
  double weight = 0.0; // barycentric; 1 of the nearest frame outside the hull
};

struct MapPickReport {
  StoredMapRecord record;             // of the maps
  MapState state = MapState::missing; // unless fresh, they were made for this
  bool inside = false;                // else there is no triangle: the nearest frame alone
  std::vector<PickedPoint> corners;   // three, or the nearest frame
  PickedPoint nearest;
  double nearest_distance = 0.0; // in the map's unit
  Eigen::VectorXd coefficients;  // #dimensions, of the picked motion frame
  std::vector<std::string> channel_names;
  Eigen::VectorXd channels; // #channels, E11; mm, or weights
  std::optional<double> aperture_mm;
  std::string face_note; // how well the face fits; empty without
};

// The motion frame at a place of a map (E section IV). Throws UsageError, InputError, IoError and
// Interrupted.
MapPickReport pick_on_map(const MapPickOptions& options, const Progress& progress);

} // namespace phonomime
