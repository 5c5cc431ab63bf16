// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/density.h"
#include "isomap/map_places.h"
#include "isomap/palette.h"

#include <cstdint>
#include <string>
#include <vector>

namespace phonomime {

// What a motion node's trajectory is shown as, what lies under the others first.
enum class TrajectoryRole { node, pruned, suspect, context_correct, chosen };

// A motion node on the map: a line from its first frame to an arrow's head at its last.
struct MapTrajectory {
  MapPlaces places;         // #frames by 2, map unit
  std::int32_t emotion = 0; // into MapPicture::emotions
  TrajectoryRole role = TrajectoryRole::node;
};

// What a single place is marked as. time_correct: where a node is at the relative time asked for;
// context_correct: the same for a node whose triphone context is right as well; chosen: for a node
// of the chosen path; picked: where someone has pointed.
enum class MarkRole { time_correct, context_correct, chosen, picked };

struct MapMark {
  double x = 0.0, y = 0.0; // map unit
  MarkRole role = MarkRole::time_correct;
};

// A map as people see it: densities of all frames (E3), trajectories, marks, and a legend of what
// occurs.
struct MapPicture {
  std::string title;                    // may be empty
  MapPlaces places;                     // #frames by 2, map unit
  std::vector<std::int32_t> emotion_of; // #frames, into `emotions`
  std::vector<std::string> emotions;
  std::vector<Colour> palette; // one for each emotion
  std::vector<MapTrajectory> trajectories;
  std::vector<MapMark> marks;
};

struct MapPictureOptions {
  int width_px = 1000;
  int height_px = 800; // of the map; title and legend come on top
  bool legend = true;  // and title
  DensityOptions density;

  // Throws InputError that names the value: sides outside 64 to 8192, sigma_px outside 0.5 to 500,
  // rho outside 0 to 1 (1 excluded).
  void validate() const;
};

// How places and the picture's pixels belong together; `top_px` more is above the map.
struct MapPictureView {
  MapView map;
  int top_px = 0;
};
MapPictureView view_of(const MapPicture& picture, const MapPictureOptions& options);

// The bytes of a PNG or of an SVG file (the density in it is an image, all else are paths and
// texts). The same bytes for any number of threads; texts of a PNG depend on the machine's fonts.
// Throw InputError (options) and InternalError (sizes that do not fit).
std::string draw_png(const MapPicture& picture, const MapPictureOptions& options = {});
std::string draw_svg(const MapPicture& picture, const MapPictureOptions& options = {});

} // namespace phonomime
