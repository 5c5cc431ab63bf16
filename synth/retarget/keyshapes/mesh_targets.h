// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/keyshapes/rig.h"
#include "synth/retarget/keyshapes/rig_motion.h"
#include "synth/retarget/triangle_mesh.h"

#include <vector>

namespace phonomime {

// What the keyshapes of a rig do to a mesh: each vertex' offset from rest, the parts "lower" and
// "upper" faded into one another at the seam (T section 3.2). Values are named "vertex N.x".
// `poses`: one for each keyshape, in order. Throws InputError for a pose with another number of
// vertices.
RigTargets mesh_targets(const Rig& rig, const TriangleMesh& rest,
                        const std::vector<TriangleMesh>& poses);

} // namespace phonomime
