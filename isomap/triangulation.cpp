// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/triangulation.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace phonomime {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, Structure>;
using Point = Kernel::Point_2;
using Corners = std::array<std::int32_t, 3>;

// The first point of each place that is taken.
std::vector<std::pair<Point, std::int32_t>> distinct_points(const MapPlaces& places) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(places.rows()));
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t i) { return std::tuple(places(i, 0), places(i, 1), i); };
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
  const auto last = std::unique(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return places(a, 0) == places(b, 0) && places(a, 1) == places(b, 1);
  });
  order.erase(last, order.end());
  std::sort(order.begin(), order.end());
  std::vector<std::pair<Point, std::int32_t>> points;
  points.reserve(order.size());
  for (const std::int32_t i : order) {
    points.emplace_back(Point(places(i, 0), places(i, 1)), i);
  }
  return points;
}

Corners corners_of(const Delaunay::Face_handle& face) {
  Corners corners = {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
  std::sort(corners.begin(), corners.end());
  return corners;
}

double twice_area(const MapPlaces& places, std::int32_t a, std::int32_t b, double x, double y) {
  return (places(a, 0) - x) * (places(b, 1) - y) - (places(b, 0) - x) * (places(a, 1) - y);
}

std::array<double, 3> barycentric(const MapPlaces& places, const Corners& corners, double x,
                                  double y) {
  const auto [a, b, c] = corners;
  const double whole = twice_area(places, a, b, places(c, 0), places(c, 1));
  std::array<double, 3> weights = {twice_area(places, b, c, x, y) / whole,
                                   twice_area(places, c, a, x, y) / whole,
                                   twice_area(places, a, b, x, y) / whole};
  double sum = 0.0;
  for (double& weight : weights) { // rounding may leave the triangle by a hair
    weight = std::isfinite(weight) ? std::clamp(weight, 0.0, 1.0) : 0.0;
    sum += weight;
  }
  if (!(sum > 0.0)) { // a triangle without an area that doubles can tell
    return {1.0, 0.0, 0.0};
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

} // namespace

struct MapTriangulation::Impl {
  MapPlaces places;
  Delaunay delaunay;

  // The triangle with the smallest corners among those that cover a place; none where it is
  // outside.
  Delaunay::Face_handle covering(const Point& point) const {
    Delaunay::Face_handle best;
    const auto consider = [&](const Delaunay::Face_handle& face) {
      if (!delaunay.is_infinite(face) &&
          (best == Delaunay::Face_handle() || corners_of(face) < corners_of(best))) {
        best = face;
      }
    };
    Delaunay::Locate_type where = Delaunay::OUTSIDE_AFFINE_HULL;
    int index = 0;
    const Delaunay::Face_handle face = delaunay.locate(point, where, index);
    if (where == Delaunay::FACE) {
      consider(face);
    } else if (where == Delaunay::EDGE) {
      consider(face);
      consider(face->neighbor(index));
    } else if (where == Delaunay::VERTEX) {
      auto around = delaunay.incident_faces(face->vertex(index));
      const auto begin = around;
      do {
        consider(around);
      } while (++around != begin);
    }
    return best;
  }
};

MapTriangulation::MapTriangulation(MapPlaces places) : impl_(std::make_unique<Impl>()) {
  if (!places.allFinite()) {
    throw InternalError({.where = "map triangulation", .what = "a place is not finite"});
  }
  const auto points = distinct_points(places);
  impl_->delaunay.insert(points.begin(), points.end());
  impl_->places = std::move(places);
}

MapTriangulation::MapTriangulation(MapTriangulation&&) noexcept = default;
MapTriangulation& MapTriangulation::operator=(MapTriangulation&&) noexcept = default;
MapTriangulation::~MapTriangulation() = default;

const MapPlaces& MapTriangulation::places() const {
  return impl_->places;
}

std::vector<Corners> MapTriangulation::triangles() const {
  std::vector<Corners> triangles;
  triangles.reserve(impl_->delaunay.number_of_faces());
  for (const auto& face : impl_->delaunay.finite_face_handles()) {
    Corners corners = {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

PickedFrame MapTriangulation::pick(double x, double y) const {
  if (!std::isfinite(x) || !std::isfinite(y)) {
    throw InputError({.where = "map pick",
                      .what = "the place is not on any map",
                      .expected = "two finite numbers",
                      .got = format_number(x) + " " + format_number(y)});
  }
  PickedFrame picked;
  double nearest_sq = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < impl_->places.rows(); ++i) {
    const double dx = impl_->places(i, 0) - x;
    const double dy = impl_->places(i, 1) - y;
    if (dx * dx + dy * dy < nearest_sq) {
      nearest_sq = dx * dx + dy * dy;
      picked.nearest = static_cast<std::int32_t>(i);
    }
  }
  if (picked.nearest < 0) {
    return picked;
  }
  picked.nearest_distance = std::sqrt(nearest_sq);
  picked.corners.fill(picked.nearest);
  if (impl_->delaunay.dimension() == 2) {
    const auto face = impl_->covering(Point(x, y));
    if (face != Delaunay::Face_handle()) {
      picked.inside = true;
      picked.corners = corners_of(face);
      picked.weights = barycentric(impl_->places, picked.corners, x, y);
    }
  }
  return picked;
}

Eigen::VectorXd interpolate_frame(const PickedFrame& picked, const FrameMatrix& frames) {
  Eigen::VectorXd frame = Eigen::VectorXd::Zero(frames.cols());
  for (std::size_t corner = 0; corner < 3; ++corner) {
    if (picked.weights[corner] > 0.0) {
      frame +=
          picked.weights[corner] * frames.row(picked.corners[corner]).transpose().cast<double>();
    }
  }
  return frame;
}

} // namespace phonomime
