// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/placement.h"

#include "db/types/errors.h"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace phonomime {
namespace {

// A fit that leaves more than this share of the markers' spread is of another face or numbering.
constexpr double kWorstFit = 0.25;

} // namespace

Points Similarity::apply(const Points& points) const {
  Points moved = (scale * points) * rotation.transpose();
  moved.rowwise() += translation.transpose();
  return moved;
}

Similarity fit_similarity(const Points& from, const Points& to) {
  if (from.rows() != to.rows() || from.rows() < 3) {
    throw InternalError({.what = "a similarity needs at least 3 pairs of points",
                         .got = std::to_string(from.rows()) + " and " + std::to_string(to.rows())});
  }
  const Eigen::Matrix4d fitted = Eigen::umeyama(from.transpose(), to.transpose(), true);
  Similarity similarity;
  similarity.scale = std::cbrt(fitted.topLeftCorner<3, 3>().determinant());
  if (similarity.scale > 0.0) {
    similarity.rotation = fitted.topLeftCorner<3, 3>() / similarity.scale;
  }
  similarity.translation = fitted.topRightCorner<3, 1>();
  similarity.rms = std::sqrt((similarity.apply(from) - to).rowwise().squaredNorm().mean());
  return similarity;
}

Similarity place_on_markers(const TriangleMesh& mesh, std::span<const int> marker_vertices,
                            const Points& reference) {
  std::vector<int> groups;
  std::vector<int> vertices;
  for (std::size_t g = 0; g < marker_vertices.size(); ++g) {
    if (marker_vertices[g] >= 0) {
      groups.push_back(static_cast<int>(g));
      vertices.push_back(marker_vertices[g]);
    }
  }
  const Points to = reference(groups, Eigen::all);
  const Similarity placement = fit_similarity(mesh.positions(vertices, Eigen::all), to);
  const Points centred = to.rowwise() - to.colwise().mean();
  const double spread = std::sqrt(centred.rowwise().squaredNorm().mean());
  if (!(placement.scale > 0.0) || !(placement.rms <= kWorstFit * spread)) {
    throw InputError({.where = mesh.source,
                      .what = "the markers' vertices do not have the shape of the markers at rest",
                      .expected = fmt::format("a similarity within {:.1f} mm", kWorstFit * spread),
                      .got = fmt::format("{:.1f} mm", placement.rms),
                      .remedy = "Check the vertex numbers in the table of markers."});
  }
  return placement;
}

} // namespace phonomime
