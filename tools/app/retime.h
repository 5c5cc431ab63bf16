// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/pipeline/synthesize.h"
#include "tools/app/synth.h"
#include "tools/app/synth_inputs.h"

#include <span>
#include <string>
#include <vector>

namespace phonomime {

// A transcript that no sound fixes, at the tempo that its emotions have in the recordings: of each
// row by what is asked for at its middle. The times of constraints and of the emotions move along.
// Where every phoneme is neutral, nothing is learned or moved; an emotion that the speaker never
// recorded has no tempo. `notes` gets lines. Throws what learn_tempo throws.
void retime_input(const MotionTable& table, SynthesisInput& input, AskedEmotions& asked,
                  std::vector<std::string>& notes);

// Has the retimed transcript written too, beside the first output: hello.csv, hello.retimed.lab.
// Nothing where the options do not retime, name no output, or name a .lab themselves.
void add_retimed_transcript(SynthOptions& options);

// Rows as a Festival/xlabel file (corpora_schema/transcript.md), labels the phonemes' names, which
// every built-in phoneme set knows.
std::string xlabel_text(std::span<const PathRow> rows);

} // namespace phonomime
