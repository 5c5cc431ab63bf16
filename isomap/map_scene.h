// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/map_picture.h"

#include <string>
#include <variant>
#include <vector>

namespace phonomime {

// A picture as shapes, which both kinds of file draw alike. All lengths in pixels, y down.
struct Line {
  std::vector<Eigen::Vector2d> points;
  Colour colour;
  double width_px = 1.0, opacity = 1.0;
  bool dashed = false;
};
struct Area {
  std::vector<Eigen::Vector2d> corners;
  Colour colour;
  double opacity = 1.0;
};
struct Disc {
  Eigen::Vector2d centre;
  double radius_px = 1.0;
  Colour fill, edge;
  double edge_px = 1.0;
};
struct Label {
  Eigen::Vector2d left; // where the text begins, on its base line
  std::string text;
  double size_px = 14.0;
};
using Shape = std::variant<Line, Area, Disc, Label>;

// Shapes that belong together, in the order in which they are drawn.
struct Layer {
  std::string name;
  std::vector<Shape> shapes;
};

struct MapScene {
  int width_px = 0, height_px = 0;
  int raster_top_px = 0;
  Raster raster;
  std::vector<Layer> layers; // over the raster
};

// Throws InputError (options) and InternalError (sizes that do not fit).
MapScene compose(const MapPicture& picture, const MapPictureOptions& options);

// The bytes of a PNG file. Throws InternalError.
std::string raster_png(const Raster& raster);

} // namespace phonomime
