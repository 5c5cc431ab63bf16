// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_source.h"

#include "db/types/errors.h"
#include "synth/retarget/mapping/equation_solving.h"
#include "synth/retarget/mapping/shape_fit.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

MarkerShapes marker_shapes(const RetargetSource& source) {
  if (source.markers.vertices.empty()) {
    throw InputError(
        {.where = source.options.database.string(),
         .what = "shapes are fitted to markers, but the database is of weights",
         .remedy = "Use --method cross, or give the weights themselves without --db."});
  }
  return shapes_at_markers(source.face, source.markers.vertices, source.table.reference_pose);
}

// With what they leave of the markers' offsets: root mean square over markers and frames, mm.
RetargetedWeights with_error(FrameMatrixD weights, const MarkerShapes& shapes,
                             const FrameMatrixD& channels) {
  const FrameMatrixD left =
      (channels.rowwise() - shapes.reference.transpose()) - weights * shapes.offsets.transpose();
  double sum = 0.0;
  Eigen::Index markers = 0;
  for (std::size_t g = 0; g < shapes.on_face.size(); ++g) {
    if (shapes.on_face[g] != 0) {
      sum += left.middleCols<3>(3 * static_cast<Eigen::Index>(g)).array().square().sum();
      ++markers;
    }
  }
  const double rms = std::sqrt(sum / static_cast<double>(markers * channels.rows()));
  return {.weights = std::move(weights),
          .notes = {fmt::format("markers are left {:.2f} mm off (root mean square)", rms)},
          .figures_json = nlohmann::json{{"marker_rms_mm", rms}}.dump()};
}

} // namespace

RetargetedWeights retarget_by_fit(const RetargetSource& source, const Progress&) {
  const ShapeFit fit(marker_shapes(source), source.table.layout);
  return with_error(fit.weights(source.motion.channels), fit.shapes(), source.motion.channels);
}

RetargetedWeights retarget_by_equations(const RetargetSource& source, const Progress&) {
  const EquationSolver solver(marker_shapes(source));
  return with_error(solver.weights(source.motion.channels), solver.shapes(),
                    source.motion.channels);
}

} // namespace phonomime
