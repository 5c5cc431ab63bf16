// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tools/evaluate/made_evaluation.h"

namespace phonomime::test {

ImportedSentence made_recording(int seed) {
  ImportedSentence sentence = moving_sentence(seed);
  sentence.emotion = seed % 2 == 0 ? "neutral" : "anger";
  sentence.text = "Made <b>up</b> & \"said\" " + std::to_string(seed);
  if (seed % 3 == 0) {
    sentence.frame_has_gap[30] = sentence.frame_has_gap[31] = 1;
  }
  return sentence;
}

SynthesisedSentence made_synthesis(const MadeMethod& method, int seed) {
  SynthesisedSentence made;
  made.method = method.id;
  made.channels =
      erring_synthesis(made_recording(seed), seed, method.error_mm * (1.0 + 0.1 * (seed % 5)));
  made.joins = {{21, false}, {29, true}, {51, false}};
  return made;
}

Evaluation made_evaluation(int sentences, const std::vector<MadeMethod>& methods,
                           Showcase* showcase) {
  Evaluation evaluation;
  evaluation.run = {.corpus = "made",
                    .held_out_by = "5 folds by sentence, seed 3",
                    .folds = 5,
                    .seed = 3,
                    .rate_hz = kRate_hz,
                    .options = {{"weights", "as shipped"}},
                    .notes = {"Nothing here was recorded."}};
  evaluation.layout = made_layout();
  evaluation.main_method = methods.front().id;
  for (const MadeMethod& method : methods) {
    evaluation.methods.push_back({.id = method.id, .description = "errs, <on> \"purpose\""});
  }
  const MeasureSetup setup = made_setup();
  for (int seed = sentences - 1; seed >= 0; --seed) { // keys in another order than theirs
    const ImportedSentence recorded = made_recording(seed);
    std::vector<SynthesisedSentence> made;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      made.push_back(made_synthesis(methods[m], seed));
      evaluation.methods[m].sentences.push_back(
          measure_sentence(setup, recorded, made.back().channels, made.back().joins));
      evaluation.methods[m].folds.push_back(seed % 5);
    }
    if (showcase != nullptr) {
      showcase->offer(
          setup, recorded, made,
          measure_values(evaluation.methods[0].sentences.back().sums)[Measure::squared_error]);
    }
  }
  return evaluation;
}

} // namespace phonomime::test
