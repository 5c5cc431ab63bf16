// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "synth/retarget/mapping/marker_shapes.h"
#include "synth/retarget/weight_solver.h"

#include <optional>
#include <utility>

namespace phonomime {

struct ShapeFitOptions {
  WeightOptions solve = {.ridge = 2e-4, .sparsity = 1e-4, .smoothness = 0.1};
  // What a mm of error in the lips' opening weighs, in markers: lips that close in the motion have
  // to close on the face, whatever the shapes make of the rest.
  double opening = 50.0;

  // Throws UsageError that names the value.
  void validate() const;
};

// Direct fitting: the weights of a face's own shapes that bring the vertices under the markers
// nearest to where the markers go from their reference pose, by least squares between 0 and 1, with
// a ridge, sparsity and smoothness in time (WeightSolver). The opening of the lips (aperture_mm of
// LipMeasures) is fitted as itself, not as an offset, so that a face whose lips rest apart closes
// them too; tracked lips that overlap ask for 0.
class ShapeFit {
public:
  // Throws InternalError where shapes and layout do not belong together.
  ShapeFit(MarkerShapes shapes, const Layout& layout, const ShapeFitOptions& options = {});

  const MarkerShapes& shapes() const { return shapes_; }

  // `channels`: #frames by #channels, mm, head motion off; NaN = missing, those rows are left out.
  // #frames by #shapes.
  FrameMatrixD weights(const FrameMatrixD& channels, WeightReport* report = nullptr) const;

private:
  MarkerShapes shapes_;
  std::optional<std::pair<int, int>> lips_; // channels: y of the upper and of the lower inner lip
  WeightSolver solver_;
};

} // namespace phonomime
