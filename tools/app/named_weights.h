// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "synth/retarget/shape_face.h"
#include "synth/retarget/shape_motion.h"
#include "tools/app/retarget_apply.h"

namespace phonomime {

// Motion of weights as it is: each goes to the shapes of its name (weights_for_face), at the rate
// that is asked for, gaps bridged; head and eyes are those of a Live Link Face take. `report` is
// told what was left out and what there is to note. Throws InputError.
ShapeMotion motion_of_weights(const RetargetApplyOptions& options, const MotionClip& clip,
                              const ShapeFace& face, RetargetReport& report);

} // namespace phonomime
