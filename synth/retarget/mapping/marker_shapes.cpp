// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/marker_shapes.h"

#include "db/types/errors.h"

#include <limits>

namespace phonomime {

MarkerShapes shapes_at_markers(const ShapeFace& face, std::span<const int> marker_vertices,
                               const Eigen::VectorXd& reference_pose) {
  const auto markers = static_cast<Eigen::Index>(marker_vertices.size());
  if (reference_pose.size() != 3 * markers || face.names.size() != face.offsets.size()) {
    throw InternalError({.what = "a face with shapes and its markers do not belong together"});
  }
  if (face.names.empty()) {
    throw InputError({.where = face.neutral.source,
                      .what = "the face has no blendshapes",
                      .expected = "a GLB with morph targets"});
  }
  MarkerShapes shapes{
      .names = face.names,
      .offsets = Eigen::MatrixXd::Zero(3 * markers, static_cast<Eigen::Index>(face.names.size())),
      .rest = Eigen::VectorXd::Constant(3 * markers, std::numeric_limits<double>::quiet_NaN()),
      .reference = reference_pose,
      .on_face = std::vector<char>(marker_vertices.size(), 0),
      .placement = {}};
  shapes.placement = place_on_markers(face.neutral, marker_vertices,
                                      Eigen::Map<const Points>(reference_pose.data(), markers, 3));
  const Eigen::Matrix3d turn = shapes.placement.scale * shapes.placement.rotation;
  for (Eigen::Index g = 0; g < markers; ++g) {
    const int vertex = marker_vertices[static_cast<std::size_t>(g)];
    if (vertex < 0) {
      continue;
    }
    shapes.on_face[static_cast<std::size_t>(g)] = 1;
    shapes.rest.segment<3>(3 * g) =
        turn * face.neutral.positions.row(vertex).transpose() + shapes.placement.translation;
    for (std::size_t s = 0; s < face.offsets.size(); ++s) {
      shapes.offsets.block<3, 1>(3 * g, static_cast<Eigen::Index>(s)) =
          turn * face.offsets[s].row(vertex).transpose();
    }
  }
  return shapes;
}

} // namespace phonomime
