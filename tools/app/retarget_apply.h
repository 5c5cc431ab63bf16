// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "tools/app/rig_weights.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// How motion becomes weights of a face's shapes.
enum class RetargetMethod {
  weights,   // it is weights: to the shapes of their names
  fit,       // of markers: shapes known on the markers' vertices, by bounded least squares
  cross,     // X4-X6 by pairs of frames and weights
  equations, // of markers: X7
  keyshapes  // T Eq. 3.2 by a rig that says what the face does for each keyshape
};

struct RetargetApplyOptions {
  std::filesystem::path motion;   // .csv (markers, weights, Live Link Face) or .c3d
  std::filesystem::path database; // whose layout and head the markers have
  std::string speaker;            // may be empty where the database holds only one
  std::filesystem::path layout;   // of the motion, where its unit or axes are not the database's
  std::filesystem::path face;
  std::string method;            // empty: weights for weights, else fit
  std::filesystem::path pairs;   // of cross
  std::optional<int> dimensions; // of cross: of the PCA; 0 = by cross-validation
  RigChoice rig;                 // of keyshapes
  WeightChoices weights;         // of fit and keyshapes
  std::filesystem::path audio;   // for .html
  std::vector<std::filesystem::path> outputs;
  double fps = 0.0;      // 0: the motion's own, 1 to 1000
  double filter_s = 0.0; // width of the weights' filter (weight_filter.h), 0 to 1
  bool head = true;
  bool skip_missing = false;
};

// What was done.
struct RetargetReport {
  RetargetMethod method = RetargetMethod::weights;
  long frames = 0;
  double rate_hz = 0.0;
  std::size_t shapes = 0;            // of the face
  std::size_t moved = 0;             // of them with a weight that changes
  std::vector<std::string> left_out; // names of weights that the face does not have
  std::vector<std::string> notes;    // for people
  std::string figures_json;          // what a method says of itself, a JSON object; may be empty
  std::vector<std::filesystem::path> written;
};

// Throws UsageError, InputError, IoError and Interrupted.
RetargetReport apply_to_face(const RetargetApplyOptions& options, const Progress& progress);

// "weights", "fit", "cross", "equations", "keyshapes".
const char* retarget_method_name(RetargetMethod method);

} // namespace phonomime
