// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/pipeline/synthesize.h"
#include "tools/app/synth.h"

#include <string>
#include <vector>

namespace phonomime {

// The request as the recipe takes it, read from the files that `options` names; `default_weights`
// hold where those say nothing else. `notes` gets a line for each choice made for the user. Throws
// InputError and IoError.
SynthesisInput read_synthesis_input(const SynthOptions& options, const MotionTable& table,
                                    const CostWeights& default_weights,
                                    std::vector<std::string>& notes);

} // namespace phonomime
