// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/tools/evaluate/made_sentences.h"
#include "tools/evaluate/aggregate.h"
#include "tools/evaluate/showcase.h"

#include <string>
#include <vector>

namespace phonomime::test {

// What a method of a made evaluation errs by: the sentence's own error is this times
// 1 + 0.1 (seed % 5).
struct MadeMethod {
  std::string id;
  double error_mm = 0.0;
};

// An evaluation of `sentences` moving sentences in two emotions and five folds, not aggregated yet.
// `showcase`, where given, is offered every sentence.
Evaluation made_evaluation(int sentences, const std::vector<MadeMethod>& methods,
                           Showcase* showcase = nullptr);

// The recording of a made evaluation's sentence, and a method's synthesis of it.
ImportedSentence made_recording(int seed);
SynthesisedSentence made_synthesis(const MadeMethod& method, int seed);

} // namespace phonomime::test
