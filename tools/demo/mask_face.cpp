// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/mask_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include <Eigen/LU>

#include "tools/demo/marker_layout.h"
#include "tools/demo/random.h"

namespace phonomime::demo {

namespace {

using Eigen::Vector2d;

constexpr double kMouth_y = -43.0;
constexpr double kMouthHalfWidth = 22.0;

double bump(double x, double y, double height, double x_sigma, double y_middle, double y_sigma) {
  const double u = x / x_sigma;
  const double v = (y - y_middle) / y_sigma;
  return height * std::exp(-0.5 * (u * u + v * v));
}

// Depth of the parametric head at a place of the picture plane, mm.
double depth(const Vector2d& p) {
  const double x = p.x();
  const double y = p.y();
  const double inside = 1.0 - (x / 72.0) * (x / 72.0) - (y / 125.0) * (y / 125.0);
  return -28.0 + 82.0 * std::sqrt(std::max(0.0, inside)) + bump(x, y, 22.0, 8.0, -7.0, 13.0) +
         bump(x, y, 8.0, 16.0, kMouth_y, 9.0) + bump(x, y, 14.0, 20.0, -92.0, 14.0);
}

// Places in the picture plane by marker index, the lips held `gap` mm apart in the middle.
class Plan {
public:
  explicit Plan(double gap) : places_(marker_vertices().size()) {
    place_lips(gap);
    place_outline();
    place_cheeks_and_nose();
    place_eyes();
  }
  const std::vector<Vector2d>& places() const { return places_; }

private:
  void set(int vertex, double x, double y) {
    places_[static_cast<std::size_t>(marker_index(vertex))] = {x, y};
  }
  // The left one at +x, the right one at -x.
  void set_pair(int left, int right, double x, double y) {
    set(left, x, y);
    set(right, -x, y);
  }

  void place_lips(double gap) {
    constexpr double kColumns[] = {-0.85, -0.69, -0.48, -0.25, 0.0, 0.25, 0.48, 0.69, 0.85};
    for (std::size_t i = 0; i < kLipColumns.size(); ++i) {
      const LipColumn& column = kLipColumns[i];
      const double s = kColumns[i];
      const double round = std::sqrt(1.0 - s * s);
      const double x = s * kMouthHalfWidth;
      set(column.upper_inner, x, kMouth_y + 0.5 * gap * round);
      set(column.lower_inner, x, kMouth_y - 0.5 * gap * round);
      set(column.upper_outer, 1.1 * x, kMouth_y + 0.5 * gap * round + 7.0 * round);
      set(column.lower_outer, 1.1 * x, kMouth_y - 0.5 * gap * round - 9.0 * round);
    }
    set_pair(kInnerCornerLeft, kInnerCornerRight, kMouthHalfWidth, kMouth_y);
    set_pair(kOuterCornerLeft, kOuterCornerRight, kMouthHalfWidth + 3.5, kMouth_y);
  }

  // The jaw's edge as a quarter of an ellipse from below the ear to the chin, and the forehead.
  void place_outline() {
    constexpr std::array<std::array<int, 2>, 5> edge = {
        {{377, 148}, {400, 176}, {379, 150}, {365, 136}, {397, 172}}};
    constexpr double kAngles_deg[] = {12.0, 23.0, 42.0, 56.0, 72.0};
    for (std::size_t i = 0; i < edge.size(); ++i) {
      const double angle = kAngles_deg[i] * std::numbers::pi / 180.0;
      set_pair(edge[i][0], edge[i][1], 62.0 * std::sin(angle), -45.0 - 51.0 * std::cos(angle));
    }
    set(152, 0.0, -96.0);
    set(151, 0.0, 66.0);
    set(10, 0.0, 84.0);
  }

  void place_cheeks_and_nose() {
    set_pair(280, 50, 48.0, -5.0);
    set_pair(425, 205, 37.0, -14.0);
    set_pair(411, 187, 53.0, -24.0);
    set_pair(427, 207, 43.0, -29.0);
    set_pair(436, 216, 33.0, -31.0);
    set_pair(327, 98, 13.0, -17.0);
    constexpr int bridge[] = {168, 6, 197, 195, 5, 4, 1, 2};
    for (int i = 0; i < 8; ++i)
      set(bridge[i], 0.0, 34.0 - 7.5 * i);
  }

  void place_eyes() {
    set_pair(263, 33, 45.0, 26.0);
    set_pair(362, 133, 17.0, 26.0);
    set_pair(386, 159, 31.0, 30.0);
    set_pair(374, 145, 31.0, 23.0);
    constexpr std::array<std::array<int, 2>, 5> brow = {
        {{336, 107}, {296, 66}, {334, 105}, {293, 63}, {300, 70}}};
    for (std::size_t i = 0; i < brow.size(); ++i) {
      const double share = 0.25 * static_cast<double>(i);
      set_pair(brow[i][0], brow[i][1], 14.0 + 42.0 * share,
               46.0 + 5.0 * std::sin(0.75 * std::numbers::pi * share + 0.3));
    }
  }

  std::vector<Vector2d> places_;
};

// Positive where d lies inside the circle through a, b, c (counter-clockwise).
double in_circle(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  Eigen::Matrix3d m;
  const Vector2d corners[] = {a - d, b - d, c - d};
  for (int i = 0; i < 3; ++i)
    m.row(i) << corners[i].x(), corners[i].y(), corners[i].squaredNorm();
  return m.determinant();
}

// Delaunay's triangles by their definition: no other point inside the circle through the corners.
// The points are moved by up to a micrometre so that mirrored ones do not share a circle.
std::vector<std::array<int, 3>> triangulate(std::vector<Vector2d> points) {
  Random random(1);
  for (Vector2d& p : points)
    p += Vector2d(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3));
  const int count = static_cast<int>(points.size());
  std::vector<std::array<int, 3>> triangles;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      for (int c = b + 1; c < count; ++c) {
        const Vector2d ab = points[b] - points[a];
        const Vector2d ac = points[c] - points[a];
        const bool turns_left = ab.x() * ac.y() - ab.y() * ac.x() > 0.0;
        const int second = turns_left ? b : c;
        const int third = turns_left ? c : b;
        bool empty = true;
        for (int d = 0; d < count && empty; ++d)
          empty = d == a || d == b || d == c ||
                  in_circle(points[a], points[second], points[third], points[d]) <= 0.0;
        if (empty)
          triangles.push_back({a, second, third});
      }
  return triangles;
}

std::vector<std::set<int>> holes() {
  std::set<int> mouth = {marker_index(kInnerCornerRight), marker_index(kInnerCornerLeft)};
  for (const LipColumn& column : kLipColumns) {
    mouth.insert(marker_index(column.upper_inner));
    mouth.insert(marker_index(column.lower_inner));
  }
  const auto eye = [](std::array<int, 4> ring) {
    std::set<int> markers;
    for (const int vertex : ring)
      markers.insert(marker_index(vertex));
    return markers;
  };
  return {mouth, eye({33, 159, 133, 145}), eye({263, 386, 362, 374})};
}

} // namespace

FaceMesh mask_mesh() {
  constexpr double kParted_mm = 6.0;
  FaceMesh mesh;
  const Plan closed(0.0);
  for (const Vector2d& place : closed.places())
    mesh.vertices_mm.emplace_back(place.x(), place.y(), depth(place));
  mesh.triangles = triangulate(Plan(kParted_mm).places());
  for (const std::set<int>& hole : holes())
    std::erase_if(mesh.triangles, [&](const std::array<int, 3>& t) {
      return std::all_of(t.begin(), t.end(), [&](int corner) { return hole.contains(corner); });
    });
  return mesh;
}

FaceModel mask_face_model() {
  const FaceMesh mesh = mask_mesh();
  FaceModel model;
  model.rest.resize(static_cast<Eigen::Index>(mesh.vertices_mm.size()), 3);
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i)
    model.rest.row(static_cast<Eigen::Index>(i)) = mesh.vertices_mm[i].transpose();
  model.obj_text = format_obj(mesh, "A mask over the markers of Phonomime's demo corpus, "
                                    "centimetres; vertex i is marker i of layout.json");
  model.marker_vertex.resize(mesh.vertices_mm.size());
  std::iota(model.marker_vertex.begin(), model.marker_vertex.end(), 0);
  return model;
}

FaceModel canonical_face_model(std::string_view obj_text, std::string_view where) {
  const std::span<const int> vertices = marker_vertices();
  return {.rest = closed_rest_pose(parse_canonical_face(obj_text, where)),
          .obj_text = std::string(obj_text),
          .marker_vertex = {vertices.begin(), vertices.end()}};
}

} // namespace phonomime::demo
