// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/opening_cut.h"

#include "synth/retarget/edge_graph.h"
#include "synth/retarget/marker_map.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

namespace phonomime {
namespace {

// Inner lips and eyelids of the 468-vertex canonical face (MediaPipe's numbering), in order.
constexpr std::array<int, 20> kMouthRing = {78,  95,  88,  178, 87,  14, 317, 402, 318, 324,
                                            308, 415, 310, 311, 312, 13, 82,  81,  80,  191};
constexpr std::array<int, 16> kRightEyeRing = {33,  7,   163, 144, 145, 153, 154, 155,
                                               133, 173, 157, 158, 159, 160, 161, 246};
constexpr std::array<int, 16> kLeftEyeRing = {263, 249, 390, 373, 374, 380, 381, 382,
                                              362, 398, 384, 385, 386, 387, 388, 466};

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// An opening by the vertices of its four markers.
struct Opening {
  std::string name;
  int right = -1;
  int upper = -1;
  int left = -1;
  int lower = -1;
  std::span<const int> canonical_ring;

  bool complete() const { return std::min({right, upper, left, lower}) >= 0; }
};

class FillFinder {
public:
  FillFinder(const TriangleMesh& mesh, const Points& positions)
      : skin_(mesh.triangles.middleRows(mesh.parts.front().first_triangle,
                                        mesh.parts.front().triangle_count)),
        positions_(positions), graph_(positions, skin_) {}

  bool has_ring(std::span<const int> ring) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int a = ring[i];
      const int b = ring[(i + 1) % ring.size()];
      if (std::max(a, b) >= graph_.vertex_count() || !graph_.has_edge(a, b)) {
        return false;
      }
    }
    return true;
  }

  // Triangles on the smaller side of a closed loop of edges; none where the loop has one side only.
  std::vector<int> inside(std::span<const int> ring) {
    list_edges();
    std::set<Edge> wall;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      wall.insert(edge_of(ring[i], ring[(i + 1) % ring.size()]));
    }
    std::vector<char> seen(static_cast<std::size_t>(skin_.rows()), 0);
    std::vector<int> smallest;
    int sides = 0;
    for (const Edge& edge : wall) {
      for (const int seed : around_edge_.at(edge)) {
        if (seen[static_cast<std::size_t>(seed)] != 0) {
          continue;
        }
        std::vector<int> side =
            flood(seed, seen, [&](const Edge& e, int) { return !wall.contains(e); });
        if (sides++ == 0 || side.size() < smallest.size()) {
          smallest = std::move(side);
        }
      }
    }
    return sides == 2 ? smallest : std::vector<int>();
  }

  // The fill of an opening that only its four markers describe.
  std::vector<int> between(const Opening& opening) {
    const std::vector<int> path = graph_.shortest_path(opening.upper, opening.lower);
    const auto way_by = [&](int corner) {
      return (positions_.row(opening.upper) - positions_.row(corner)).norm() +
             (positions_.row(corner) - positions_.row(opening.lower)).norm();
    };
    if (path.size() < 2 ||
        graph_.path_length(path) >= 0.5 * std::min(way_by(opening.right), way_by(opening.left))) {
      return {};
    }
    list_edges();
    const auto within = [&](const Edge&, int t) { return centre_between(opening, t); };
    std::vector<char> seen(static_cast<std::size_t>(skin_.rows()), 0);
    std::vector<int> fill;
    for (std::size_t i = 1; i < path.size(); ++i) {
      for (const int seed : around_edge_.at(edge_of(path[i - 1], path[i]))) {
        if (seen[static_cast<std::size_t>(seed)] == 0 && centre_between(opening, seed)) {
          const auto more = flood(seed, seen, within);
          fill.insert(fill.end(), more.begin(), more.end());
        }
      }
    }
    return with_enclosed(std::move(fill));
  }

private:
  // Only a face with something to cut pays for it.
  void list_edges() {
    if (!around_edge_.empty()) {
      return;
    }
    for (int t = 0; t < skin_.rows(); ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        around_edge_[edge_of(skin_(t, corner), skin_(t, (corner + 1) % 3))].push_back(t);
      }
    }
  }

  template <typename MayEnter>
  std::vector<int> flood(int seed, std::vector<char>& seen, MayEnter may_enter) const {
    std::vector<int> found = {seed};
    seen[static_cast<std::size_t>(seed)] = 1;
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const Edge edge = edge_of(skin_(found[i], corner), skin_(found[i], (corner + 1) % 3));
        for (const int next : around_edge_.at(edge)) {
          if (seen[static_cast<std::size_t>(next)] == 0 && may_enter(edge, next)) {
            seen[static_cast<std::size_t>(next)] = 1;
            found.push_back(next);
          }
        }
      }
    }
    return found;
  }

  // Seen from the front: is the triangle's centre inside the quadrangle of the opening's markers?
  bool centre_between(const Opening& opening, int t) const {
    const Eigen::RowVector3d centre =
        (positions_.row(skin_(t, 0)) + positions_.row(skin_(t, 1)) + positions_.row(skin_(t, 2))) /
        3.0;
    const std::array<int, 4> corners = {opening.right, opening.upper, opening.left, opening.lower};
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::RowVector3d from = positions_.row(corners[i]);
      const Eigen::RowVector3d side = positions_.row(corners[(i + 1) % 4]) - from;
      const Eigen::RowVector3d to_centre = centre - from;
      if (side.x() * to_centre.y() - side.y() * to_centre.x() > 0.0) {
        return false; // the markers go round clockwise: right, upper, left, lower
      }
    }
    return true;
  }

  // The fill and the triangles left over in its corners: those with every vertex in the fill.
  std::vector<int> with_enclosed(std::vector<int> fill) const {
    std::set<int> vertices;
    std::set<int> all(fill.begin(), fill.end());
    for (const int t : fill) {
      vertices.insert({skin_(t, 0), skin_(t, 1), skin_(t, 2)});
    }
    for (int t = 0; t < skin_.rows(); ++t) {
      if (vertices.contains(skin_(t, 0)) && vertices.contains(skin_(t, 1)) &&
          vertices.contains(skin_(t, 2))) {
        all.insert(t);
      }
    }
    return {all.begin(), all.end()};
  }

  Triangles skin_;
  const Points& positions_;
  EdgeGraph graph_;
  std::map<Edge, std::vector<int>> around_edge_;
};

Opening mouth_of(const Layout& layout, std::span<const int> vertices) {
  const auto at = [&](std::string_view landmark) {
    const auto group = layout.find_landmark(landmark);
    return group ? vertices[static_cast<std::size_t>(*group)] : -1;
  };
  return {"mouth",
          at("mouth_corner_right"),
          at("lip_upper_inner"),
          at("mouth_corner_left"),
          at("lip_lower_inner"),
          kMouthRing};
}

// An eye by the eyelid markers of one side of the face: its corners lie farthest apart sideways.
Opening eye_of(std::string name, const Layout& layout, std::span<const int> vertices,
               const Points& positions, bool right, std::span<const int> ring) {
  std::vector<int> lids;
  double middle = 0.0;
  int count = 0;
  for (const int vertex : vertices) {
    if (vertex >= 0) {
      middle += positions(vertex, 0);
      ++count;
    }
  }
  middle /= std::max(count, 1);
  for (const int group : layout.groups_in(Region::eyelids)) {
    const int vertex = vertices[static_cast<std::size_t>(group)];
    if (vertex >= 0 && (positions(vertex, 0) < middle) == right) {
      lids.push_back(vertex);
    }
  }
  Opening eye{.name = std::move(name), .canonical_ring = ring};
  if (lids.size() < 4) {
    return eye;
  }
  std::ranges::sort(lids, {}, [&](int v) { return positions(v, 0); });
  eye.right = lids.front();
  eye.left = lids.back();
  const auto between = std::span(lids).subspan(1, lids.size() - 2);
  eye.upper = *std::ranges::max_element(between, {}, [&](int v) { return positions(v, 1); });
  eye.lower = *std::ranges::min_element(between, {}, [&](int v) { return positions(v, 1); });
  return eye;
}

} // namespace

OpeningFill find_opening_fill(const TriangleMesh& mesh, const Points& positions,
                              const Layout& layout, std::span<const int> marker_vertices) {
  OpeningFill result;
  result.filling.assign(static_cast<std::size_t>(mesh.triangle_count()), 0);
  const auto named = marker_map_from_names(layout, mesh.skin_vertex_count());
  const bool names_are_numbers = named && std::ranges::equal(named->vertices, marker_vertices);
  FillFinder finder(mesh, positions);
  for (const Opening& opening :
       {mouth_of(layout, marker_vertices),
        eye_of("right eye", layout, marker_vertices, positions, true, kRightEyeRing),
        eye_of("left eye", layout, marker_vertices, positions, false, kLeftEyeRing)}) {
    std::vector<int> fill;
    if (names_are_numbers && finder.has_ring(opening.canonical_ring)) {
      fill = finder.inside(opening.canonical_ring);
    } else if (opening.complete()) {
      fill = finder.between(opening);
    }
    if (fill.empty()) {
      continue;
    }
    result.openings.push_back({opening.name, static_cast<int>(fill.size())});
    for (const int t : fill) {
      result.filling[static_cast<std::size_t>(mesh.parts.front().first_triangle + t)] = 1;
    }
  }
  return result;
}

} // namespace phonomime
