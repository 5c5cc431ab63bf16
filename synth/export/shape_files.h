// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/shape_motion.h"

#include <string>
#include <string_view>

namespace phonomime {

// Motion of a face with shapes of its own as text. Frame k is at k / rate.

// `time,<shape>,...` in the face's own names, to six decimals.
std::string shape_weight_csv(const ShapeMotion& motion);

// Live Link Face's 63 columns (motion_csv.h) of the shapes whose names mean ARKit's; a shape that
// the face has in two halves is their mean, one that it does not have 0. HeadYaw, HeadPitch and
// HeadRoll are rad: yaw to the head's own left is positive, so are pitch up and roll to its own
// left.
std::string shape_live_link_csv(const ShapeMotion& motion);

// Biovision hierarchy: one joint `head`, position in centimetres and rotation in degrees, Y X Z,
// in the speaker's axes (x to the right of the picture, y up, z towards the camera).
std::string head_bvh(const ShapeMotion& motion);

// Python for Maya's script editor, and for Blender's: each finds the shapes by their names and keys
// them, and the head on a node of its own. `face` is the face's file, for the comment.
std::string maya_script(const ShapeMotion& motion, std::string_view face);
std::string blender_script(const ShapeMotion& motion, std::string_view face);

} // namespace phonomime
