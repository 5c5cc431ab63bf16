// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "synth/retarget/keyshapes/reconstruction_error.h"
#include "synth/retarget/keyshapes/rig.h"
#include "synth/retarget/keyshapes/select_keyshapes.h"

#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

struct ChooseKeyshapesOptions {
  std::filesystem::path database;
  std::string speaker;                       // may be empty where there is only one
  std::vector<std::string> parts = {"face"}; // part_channels: decomposed apart
  bool by_emotion = false;                   // a set for each emotion, else one of all frames
  KeyshapeOptions keyshapes;                 // for each set
  std::string target = "shapes";             // what the rig is begun for: kRigTargetNames
  std::filesystem::path face;                // to show each keyshape on; may be empty
  std::filesystem::path output;              // folder
};

// A frame that was chosen.
struct ChosenKeyshape {
  std::string name;
  std::string node;           // its key
  double relative_time = 0.0; // in the node, 0 to 1
  int axis = -1;              // as Keyshape
  bool largest = false;
};

// What was chosen together.
struct KeyshapeSet {
  std::string expression, part;
  std::vector<ChosenKeyshape> keyshapes;
  long frames = 0;            // to choose from
  long measured = 0;          // of them
  std::size_t left_out = 0;   // extrema like others
  double mean_square = 0.0;   // what the keyshapes leave of the measured frames
  double motion_square = 0.0; // mean square of the measured frames themselves
  std::vector<ErrorCurve> curves;
};

struct KeyshapeChoice {
  std::vector<KeyshapeSet> sets;
  FrameMatrixD coefficients; // #keyshapes of all sets, in order, by #dimensions
};

struct ChooseKeyshapesReport {
  KeyshapeChoice choice;
  bool fitted = false; // the rig's weights are those of a direct fit, else to be filled in
  std::vector<std::filesystem::path> written;
};

// The frames of a speaker's motion nodes that cover the motion (T section 3.1.2), set by set, with
// T figure 3.6's error curves. Throws UsageError, InputError and Interrupted.
KeyshapeChoice choose_keyshapes(const MotionTable& table, const ChooseKeyshapesOptions& options,
                                const Progress& progress);

// Chooses them in a database and writes their folder (keyshape_folder). All or nothing. Throws also
// IoError.
ChooseKeyshapesReport write_keyshapes(const ChooseKeyshapesOptions& options,
                                      const Progress& progress);

} // namespace phonomime
