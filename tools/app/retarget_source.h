// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "synth/retarget/mapping/marker_shapes.h"
#include "synth/retarget/shape_face.h"
#include "tools/app/motion_file.h"
#include "tools/app/retarget_apply.h"

#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// What every method of `retarget apply` but `weights` is given.
struct RetargetSource {
  const RetargetApplyOptions& options;
  const MotionTable& table; // of the database
  const MotionFile& motion; // in the table's layout, the head taken off
  const ShapeFace& face;
  const std::optional<MarkerShapes>& shapes; // under the markers, for `fit` and `equations`
};

// What it gives.
struct RetargetedWeights {
  FrameMatrixD weights; // #frames of the motion by #shapes of the face
  std::vector<std::string> notes;
  std::string figures_json; // as RetargetReport::figures_json
};

// One for each method; each throws UsageError and InputError. They live in files of their own.
RetargetedWeights retarget_by_fit(const RetargetSource& source, const Progress& progress);
RetargetedWeights retarget_by_equations(const RetargetSource& source, const Progress& progress);
RetargetedWeights retarget_by_cross_mapping(const RetargetSource& source, const Progress& progress);
RetargetedWeights retarget_by_keyshapes(const RetargetSource& source, const Progress& progress);

} // namespace phonomime
