// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/choose_keyshapes.h"

#include <map>
#include <string>
#include <string_view>

namespace phonomime {

// A kind of target by its name in rigs. Throws UsageError, about --target.
RigTarget rig_target_named(std::string_view name);

struct KeyshapeFolder {
  std::map<std::string, std::string> files; // name: bytes
  bool fitted = false;                      // ChooseKeyshapesReport
};

// What an artist poses a character by:
//     keyshapes.csv         a keyshape a row, in the layout
//     rig.json              to be filled in
//     errors_*.svg, .tsv    T figure 3.6 for each set
//     k00.svg ...           each keyshape's markers
//     k00.png, .glb ...     with a face, the mesh as these markers move it
// With a face that has shapes and places markers, a rig of `shapes` has the weights of a direct
// fit; a rig of a `mesh` takes k00.glb ... and rest.glb as they are: both to be changed by hand.
// `face` may be empty. Throws InputError, IoError and Interrupted.
KeyshapeFolder keyshape_folder(const KeyshapeChoice& choice, const MotionTable& table,
                               RigTarget target, const std::filesystem::path& face,
                               const Progress& progress);

} // namespace phonomime
