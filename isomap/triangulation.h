// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "isomap/map_places.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace phonomime {

// What a picked place stands for.
struct PickedFrame {
  // Inside the hull of the map: the corners of the triangle that covers the place, ascending, and
  // its barycentric coordinates (each 0 to 1, sum 1). Outside: the nearest point alone, three
  // times, with weights 1, 0, 0. Indices are into the map's points; -1 where the map has none.
  bool inside = false;
  std::array<std::int32_t, 3> corners = {-1, -1, -1};
  std::array<double, 3> weights = {1.0, 0.0, 0.0};
  std::int32_t nearest = -1;     // the point nearest on the map, ties to the smaller index
  double nearest_distance = 0.0; // map unit
};

// The Delaunay triangulation of a map's points (E section IV, Fig. 7), by CGAL with exact
// predicates. Of points at one place the first stands for all. Points that lie all on one line have
// no triangles: every pick is outside and gives the nearest. Several threads may pick at once.
class MapTriangulation {
public:
  // `places`: #points by 2, finite; kept.
  explicit MapTriangulation(MapPlaces places);
  MapTriangulation(MapTriangulation&&) noexcept;
  MapTriangulation& operator=(MapTriangulation&&) noexcept;
  ~MapTriangulation();

  const MapPlaces& places() const;

  // Corners counter-clockwise, the smallest index first; in increasing order.
  std::vector<std::array<std::int32_t, 3>> triangles() const;

  // The frame at a place in the map's unit. A place on an edge or a corner belongs to the triangle
  // that has the smaller corners. Throws InputError where x or y is not finite.
  PickedFrame pick(double x, double y) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The picked motion frame: the weighted mean of its corners' frames (#dimensions). `frames`:
// #points by #dimensions, row i is the frame of point i.
Eigen::VectorXd interpolate_frame(const PickedFrame& picked, const FrameMatrix& frames);

} // namespace phonomime
