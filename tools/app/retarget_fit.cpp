// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "synth/retarget/mapping/equation_solving.h"
#include "synth/retarget/mapping/region_errors.h"
#include "synth/retarget/mapping/shape_fit.h"
#include "tools/app/retarget_source.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

const MarkerShapes& shapes_of(const RetargetSource& source) {
  if (!source.shapes) {
    throw InternalError({.what = "no shapes were placed under the markers"});
  }
  return *source.shapes;
}

// Root mean square over markers on the face and frames, mm.
double marker_rms(const RetargetSource& source, const FrameMatrixD& weights) {
  const MarkerShapes& shapes = shapes_of(source);
  const FrameMatrixD left = (source.motion.channels.rowwise() - shapes.reference.transpose()) -
                            weights * shapes.offsets.transpose();
  double sum = 0.0;
  Eigen::Index markers = 0;
  for (std::size_t g = 0; g < shapes.on_face.size(); ++g) {
    if (shapes.on_face[g] != 0) {
      sum += left.middleCols<3>(3 * static_cast<Eigen::Index>(g)).array().square().sum();
      ++markers;
    }
  }
  return std::sqrt(sum / static_cast<double>(markers * left.rows()));
}

// With what they leave of the markers' offsets, also in each region of the face.
RetargetedWeights with_errors(FrameMatrixD weights, const RetargetSource& source,
                              nlohmann::ordered_json figures) {
  const double rms = marker_rms(source, weights);
  figures["marker_rms_mm"] = rms;
  std::string regions;
  for (const RegionError& error :
       region_errors(shapes_of(source), source.table.layout, source.motion.channels, weights)) {
    const std::string name(kRegionNames.at(static_cast<std::size_t>(error.region)));
    figures["regions"][name] = {{"markers", error.markers}, {"rms_mm", error.rms_mm}};
    regions += fmt::format("{}{} {:.2f}", regions.empty() ? "" : ", ", name, error.rms_mm);
  }
  return {
      .weights = std::move(weights),
      .notes = {fmt::format("markers are left {:.2f} mm off (root mean square; {})", rms, regions)},
      .figures_json = figures.dump()};
}

} // namespace

RetargetedWeights retarget_by_fit(const RetargetSource& source, const Progress&) {
  ShapeFitOptions options;
  options.solve = source.options.weights.over(options.solve);
  const ShapeFit fit(shapes_of(source), source.table.layout, options);
  return with_errors(fit.weights(source.motion.channels), source, {});
}

RetargetedWeights retarget_by_equations(const RetargetSource& source, const Progress&) {
  const EquationSolver solver(shapes_of(source));
  const Eigen::Vector3d& scale = solver.proportions();
  return with_errors(solver.weights(source.motion.channels), source,
                     {{"proportions", {scale.x(), scale.y(), scale.z()}}});
}

} // namespace phonomime
