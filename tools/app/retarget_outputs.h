// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/retarget/shape_motion.h"
#include "tools/app/retarget_apply.h"

#include <filesystem>
#include <vector>

namespace phonomime {

// Whether each output's suffix names a kind: .csv, .livelink.csv, .glb, .html, .bvh, .maya.py or
// .blender.py. Throws UsageError.
void check_retarget_outputs(const RetargetApplyOptions& options);

// Writes all outputs or none, and returns their paths. Throws InputError and IoError.
std::vector<std::filesystem::path> write_retargeted(const RetargetApplyOptions& options,
                                                    const ShapeFace& face,
                                                    const ShapeMotion& motion);

} // namespace phonomime
