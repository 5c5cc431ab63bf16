// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "synth/retarget/marker_face.h"

#include <string>
#include <vector>

namespace phonomime {

// What a file says of itself.
struct ExportNotes {
  std::string title;
  std::vector<std::string> credits;
  bool synthetic = false; // some of the motion was made, not recorded
};

// A binary glTF 2.0 file, metres, y up: the node "head" carries the face and, where the motion has
// them, the head's poses. Mesh 0 holds the parts that move, the skin first (primitive 0, vertices
// as in `mesh`); mesh 1, on a child node, those that rest with the head. One morph target, named
// "pca0" and so on in extras.targetNames, stands for each PCA dimension that this motion uses: the
// morph times the coefficient's largest size, so that the animated weights stay within [-1, 1].
// POSITION deltas are exact; NORMAL deltas are central differences. One linear key at each frame.
//
// `mesh` gives triangles, parts and materials; `targets` the shape in mm (base and one morph per
// dimension of `motion`). Throws InternalError where they do not belong together, InputError where
// the motion has no frame.
std::string make_glb(const TriangleMesh& mesh, const MorphTargets& targets,
                     const CoefficientMotion& motion, const ExportNotes& notes);

} // namespace phonomime
