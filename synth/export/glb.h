// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "synth/retarget/marker_face.h"
#include "synth/retarget/triangle_mesh.h"

#include <string>
#include <vector>

namespace phonomime {

// What a file says of itself.
struct GlbNotes {
  std::string title;
  std::vector<std::string> credits;
  bool synthetic = false;
};

// A binary glTF 2.0 file of a face in motion (DESIGN section 10), in metres, y up, z towards the
// viewer: node `head` with the head pose, under it node `face` with one mesh, a primitive for each
// part that has triangles (the skin first, its vertices numbered as in `mesh`), a morph target for
// each PCA dimension that moves, and one animation of the morphs' weights, linear between frames.
//
// E11 and E15 are linear, so that base + sum of weight times target is the deformed mesh exactly.
// A target is scaled by the largest magnitude of its coefficient in the motion: weights stay within
// [-1, 1], which Blender limits shape keys to. Normals have morphs of their own (differences at
// full weight: right there, near it in between).
//
// `morphs`: of the mesh's vertices, mm. `motion`: at the rate that its frames are to be played at,
// at least one frame. Throws InternalError where they do not fit each other.
std::string marker_face_glb(const TriangleMesh& mesh, const MorphTargets& morphs,
                            const CoefficientMotion& motion, const GlbNotes& notes);

} // namespace phonomime
