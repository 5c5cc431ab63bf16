// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/rest_pose.h"

#include "tools/demo/marker_layout.h"

namespace phonomime::demo {

MarkerPose closed_rest_pose(const FaceMesh& canonical) {
  constexpr double kOuterShare = 0.8;
  const std::span<const int> vertices = marker_vertices();
  MarkerPose rest(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    rest.row(static_cast<Eigen::Index>(i)) =
        canonical.vertices_mm.at(static_cast<std::size_t>(vertices[i])).transpose();
  for (const LipColumn& column : kLipColumns) {
    const int upper = marker_index(column.upper_inner);
    const int lower = marker_index(column.lower_inner);
    const Eigen::RowVector3d meeting = 0.5 * (rest.row(upper) + rest.row(lower));
    rest.row(marker_index(column.upper_outer)) += kOuterShare * (meeting - rest.row(upper));
    rest.row(marker_index(column.lower_outer)) += kOuterShare * (meeting - rest.row(lower));
    rest.row(upper) = meeting;
    rest.row(lower) = meeting;
  }
  return rest;
}

} // namespace phonomime::demo
