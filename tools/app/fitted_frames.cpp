// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/fitted_frames.h"

#include "synth/retarget/face_source.h"
#include "synth/retarget/mapping/shape_fit.h"

namespace phonomime {

FrameMatrixD fitted_frames(const ShapeFace& face, const std::filesystem::path& path,
                           const MotionTable& table, const FrameMatrixD& channels) {
  const MarkerMap markers = read_markers(path, table.layout, face.neutral.skin_vertex_count());
  ShapeFitOptions options;
  options.solve.smoothness = 0.0;
  const ShapeFit fit(shapes_at_markers(face, markers.vertices, table.reference_pose), table.layout,
                     options);
  return fit.weights(channels);
}

} // namespace phonomime
