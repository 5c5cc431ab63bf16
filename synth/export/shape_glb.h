// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/export/glb.h"
#include "synth/retarget/shape_motion.h"

#include <string>
#include <string_view>

namespace phonomime {

// A face's own file with the motion in it: everything else in it (skins, pictures, materials,
// targets and their names) stays as it is, but animations that it had. Every node that shows morph
// targets gets the weights of the shapes of their names (linear between frames); where the head
// moves, a node `head` above all others is turned and moved.
//
// `glb`: as parse_face_scene has read it; `where` names it in errors. Throws InputError where its
// data lies in another file.
std::string animated_glb(std::string_view glb, std::string_view where, const ShapeMotion& motion,
                         const GlbNotes& notes);

} // namespace phonomime
