// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/pipeline/synthesize.h"
#include "tools/app/synth_inputs.h"
#include "tools/app/synth_stock.h"

#include <string>
#include <vector>

namespace phonomime {

// Whether some node of the speaker shows an emotion: its name may be another speaker's.
bool is_recorded(const MotionTable& table, const std::string& emotion);

// Whether an emotion is asked for that no node can show as it is: another intensity than 1, a
// mixture, or one that `table` does not have.
bool needs_style(const EmotionMixture& asked, const MotionTable& table);

// Refuses emotions that `table` does not have. Throws InputError with file and line.
void check_names(const AskedEmotions& asked, const MotionTable& table);

// Refuses what only a style model could show (`who` cannot: "a stream"), and emotions that `table`
// does not have. Throws InputError with file and line.
void check_recorded(const AskedEmotions& asked, const MotionTable& table, const std::string& who);
void check_recorded(const EmotionMixture& asked, const MotionTable& table, const std::string& where,
                    const std::string& who);

// What the style model does after the search: intensities, mixtures, emotions that the speaker
// never recorded (the search then asks for neutral), and glides where the emotion changes. `input`
// has the emotions that the search would ask for. Where a model is not needed but lends a glide,
// one that is not there is done without. `notes` and `warnings` get lines for people. Throws
// InputError where a model is needed and there is none that is fresh, and for emotions that nothing
// knows.
void plan_style(const AskedEmotions& asked, SynthStock& stock, SynthesisInput& input,
                std::vector<std::string>& notes);

} // namespace phonomime
