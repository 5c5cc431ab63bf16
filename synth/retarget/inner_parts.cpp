// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/inner_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace phonomime {
namespace {

constexpr double kTouch_mm = 0.05;
constexpr double kGrownShare = 0.1;
constexpr double kSharedPart = 1.0 / 3.0;
constexpr double kMouthReach = 1.5; // half widths of the mouth, to each side and up

using Piece = std::vector<int>; // vertices, into the mesh

// Pieces in the order of their first vertices.
std::vector<Piece> pieces_of(const TriangleMesh& mesh, const Points& positions, int first) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.vertex_count()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) {
      v = parent[static_cast<std::size_t>(v)] =
          parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(v)])];
    }
    return v;
  };
  const auto join = [&](int a, int b) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    parent[static_cast<std::size_t>(high)] = low;
  };
  std::map<std::tuple<double, double, double>, int> welded;
  for (int v = first; v < mesh.vertex_count(); ++v) {
    const auto key = std::tuple(positions(v, 0), positions(v, 1), positions(v, 2));
    join(v, welded.emplace(key, v).first->second);
  }
  for (Eigen::Index t = mesh.parts.front().triangle_count; t < mesh.triangles.rows(); ++t) {
    join(mesh.triangles(t, 0), mesh.triangles(t, 1));
    join(mesh.triangles(t, 0), mesh.triangles(t, 2));
  }
  std::map<int, Piece> by_root;
  for (int v = first; v < mesh.vertex_count(); ++v) {
    by_root[root(v)].push_back(v);
  }
  std::vector<Piece> pieces;
  for (auto& [unused, piece] : by_root) {
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

// Vertices of the skin by x, to find one at a given place.
class SkinPlaces {
public:
  SkinPlaces(const Points& positions, int count)
      : positions_(positions), by_x_(static_cast<std::size_t>(count)) {
    std::iota(by_x_.begin(), by_x_.end(), 0);
    std::ranges::stable_sort(by_x_, {}, [&](int v) { return positions_(v, 0); });
  }

  // The vertex of the skin that touches the point, the smallest where several do; -1 = none.
  int touching(const Eigen::RowVector3d& point) const {
    auto at = std::ranges::lower_bound(by_x_, point.x() - kTouch_mm, {},
                                       [&](int v) { return positions_(v, 0); });
    int found = -1;
    for (; at != by_x_.end() && positions_(*at, 0) <= point.x() + kTouch_mm; ++at) {
      if ((positions_.row(*at) - point).norm() <= kTouch_mm && (found < 0 || *at < found)) {
        found = *at;
      }
    }
    return found;
  }

private:
  const Points& positions_;
  std::vector<int> by_x_;
};

int nearest_in(const Points& positions, const Piece& piece, int vertex) {
  return *std::ranges::min_element(
      piece, {}, [&](int v) { return (positions.row(v) - positions.row(vertex)).squaredNorm(); });
}

struct Box {
  Eigen::RowVector3d low;
  Eigen::RowVector3d high;
  Eigen::RowVector3d centre() const { return 0.5 * (low + high); }
};

Box box_of(const Points& positions, const Piece& piece) {
  Box box{positions.row(piece.front()), positions.row(piece.front())};
  for (const int v : piece) {
    box.low = box.low.cwiseMin(positions.row(v));
    box.high = box.high.cwiseMax(positions.row(v));
  }
  return box;
}

int place_of(const Box& box, const FacePlaces& places) {
  if (places.mouth) {
    const MouthPlace& mouth = *places.mouth;
    const double reach = kMouthReach * mouth.half_width;
    const Eigen::RowVector3d off = box.centre() - mouth.centre;
    if (std::abs(off.x()) < reach && off.y() < reach && box.centre().y() > mouth.chin_y &&
        off.z() < 0.0) {
      return kInMouth;
    }
  }
  for (std::size_t eye = 0; eye < places.eyes.size(); ++eye) {
    if ((box.centre() - places.eyes[eye].centre).norm() < places.eyes[eye].radius) {
      return kInFirstEye + static_cast<int>(eye);
    }
  }
  return kNowhere;
}

// The share of a piece's height that lies below the mouth's line.
double share_below(const Box& box, double line_y) {
  return std::clamp((line_y - box.low.y()) / std::max(box.high.y() - box.low.y(), 1e-9), 0.0, 1.0);
}

double squared_distance(const Points& positions, int vertex, const Piece& to) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const int v : to) {
    nearest = std::min(nearest, (positions.row(v) - positions.row(vertex)).squaredNorm());
  }
  return nearest;
}

} // namespace

InnerParts sort_inner_parts(const TriangleMesh& mesh, const Points& positions,
                            const FacePlaces& places) {
  const int first = mesh.skin_vertex_count();
  InnerParts result;
  result.vertices.resize(static_cast<std::size_t>(mesh.vertex_count() - first));
  const auto entry = [&](int v) -> InnerVertex& {
    return result.vertices[static_cast<std::size_t>(v - first)];
  };
  const SkinPlaces skin(positions, first);
  Piece upper;
  Piece lower;
  Piece shared;
  for (const Piece& piece : pieces_of(mesh, positions, first)) {
    Piece roots;
    for (const int v : piece) {
      if (skin.touching(positions.row(v)) >= 0) {
        roots.push_back(v);
      }
    }
    if (static_cast<double>(roots.size()) >= kGrownShare * static_cast<double>(piece.size())) {
      ++result.anchored;
      for (const int v : piece) {
        entry(v).anchor = skin.touching(positions.row(nearest_in(positions, roots, v)));
      }
      continue;
    }
    const Box box = box_of(positions, piece);
    const int place = place_of(box, places);
    for (const int v : piece) {
      entry(v).place = place;
    }
    if (place != kInMouth) {
      ++result.resting;
      continue;
    }
    const double below = share_below(box, places.mouth->centre.y());
    Piece& side = below < kSharedPart ? upper : below > 1.0 - kSharedPart ? lower : shared;
    side.insert(side.end(), piece.begin(), piece.end());
    ++(&side == &upper ? result.resting : &side == &lower ? result.jaw : result.shared);
  }
  for (const int v : lower) {
    entry(v).jaw = 1.0;
  }
  for (const int v : shared) {
    const double to_upper = squared_distance(positions, v, upper);
    const double to_lower = squared_distance(positions, v, lower);
    const bool between = std::isfinite(to_upper) && std::isfinite(to_lower);
    entry(v).jaw = between ? to_upper / std::max(to_upper + to_lower, 1e-12)
                           : (positions(v, 1) < places.mouth->centre.y() ? 1.0 : 0.0);
  }
  return result;
}

} // namespace phonomime
