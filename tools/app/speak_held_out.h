// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/imported_sentence.h"
#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "synth/search/search_types.h"
#include "tools/app/synth.h"
#include "tools/evaluate/measures.h"
#include "tools/evaluate/method.h"

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

// What the methods made of one sentence, and how near that is.
struct SpokenSentence {
  std::vector<SynthesisedSentence> synthesised; // #methods
  std::vector<SentenceMeasures> measures;       // #methods
  std::vector<double> search_s;                 // #methods, wall clock
};

// Has each sentence spoken by each method, made from the table of the sentence's speaker with the
// weights, joins and silences of `options`, over options.threads threads, and measures it. `take`
// gets each sentence once, in any order, one at a time. The results depend on neither threads nor
// order. `change` may alter the weights of each search once they have been read. Throws InputError,
// which names the sentence, and Interrupted.
void speak_held_out(const std::map<std::string, MotionTable>& tables,
                    std::span<const ImportedSentence> sentences,
                    std::span<const MethodEntry> methods, const SynthOptions& options,
                    const Progress& progress,
                    const std::function<void(std::size_t sentence, SpokenSentence&&)>& take,
                    const std::function<void(CostWeights&)>& change = {});

} // namespace phonomime
