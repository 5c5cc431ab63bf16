// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/map_places.h"

#include <Eigen/Core>

namespace phonomime {

// Where a map lies in a picture: one scale for both axes, y up on the map and down in the picture,
// the middle of the map's extent in the middle of the picture. Pixel (0, 0) covers [0, 1)^2.
class MapView {
public:
  // All `places` (#points by 2) inside, at least `margin_px` from the border. A map without an
  // extent is shown one unit wide.
  MapView(const MapPlaces& places, int width_px, int height_px, double margin_px);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  double px_per_unit() const { return px_per_unit_; }
  Eigen::Vector2d to_px(double x, double y) const;
  Eigen::Vector2d to_map(double x_px, double y_px) const;

private:
  int width_px_, height_px_;
  double px_per_unit_ = 1.0;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero(); // of the extent, map unit
};

} // namespace phonomime
