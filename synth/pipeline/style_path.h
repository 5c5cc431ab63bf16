// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/pipeline/synthesize.h"

namespace phonomime {

// Gives the motion of a result (at the database's rate) the style that is asked for; what its nodes
// were recorded in is what it shows. `result` has its path and its motion; the motion, its style
// and warnings are changed. Throws InputError as apply_style does.
void style_path(const MotionTable& table, const SynthesisInput& input, SynthesisResult& result);

} // namespace phonomime
