// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "synth/search/search_types.h"
#include "tools/evaluate/measure_table.h"
#include "tools/tune/journal.h"
#include "tools/tune/weight_space.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// The same sentences spoken with the shipped and with the tuned weights.
struct Scores {
  std::vector<std::string> keys; // "speaker/emotion/id"
  SentenceValues shipped, tuned; // #keys
};

// Weights that were evaluated, and the mean over sentences of the objective.
struct EvaluatedWeights {
  CostWeights weights; // PNT 0: the database's own
  double value = 0.0;
};

// Weights as tuned to some sentences.
struct TunedPart {
  int fold = 0;                        // without this fold's sentences; 0: to all of the corpus
  CostWeights tuned;                   // PNT 0
  std::vector<EvaluatedWeights> looks; // every evaluation of the search, the shipped weights first
  Scores inner;                        // the sentences that they were tuned to
  Scores held_out;                     // the fold's; of fold 0 none
};

// A tuning with what it found.
struct Tuning {
  std::string corpus;
  std::map<std::string, std::string> options; // whatever shapes the result, name -> value
  std::vector<std::string> notes;             // for people, one sentence each
  Measure objective = Measure::squared_error;
  LayoutKind kind = LayoutKind::markers;
  std::vector<TunableWeight> weights; // those that were tuned
  CostWeights shipped;                // PNT 0
  std::vector<TunedPart> folds;
  TunedPart all;            // the weights to use
  bool out_of_time = false; // the time limit ended the search
};

// How much better than the shipped weights the tuned ones are, over sentences that have a value.
struct Gain {
  std::int64_t sentences = 0;
  std::optional<double> shipped, tuned; // means
  std::optional<double> gain;           // mean of what they are better by (badness); below 0: worse
  std::optional<double> standard_error; // of it; from two sentences on
  std::int64_t better = 0, worse = 0;   // sentences
  double p_value = 1.0;                 // Wilcoxon's signed-rank test, two-sided
};
Gain gain_of(const Scores& scores, Measure objective);

// Of all folds' held-out sentences together: what is honestly to be expected of tuned weights.
Scores held_out_scores(const Tuning& tuning);
// Of all folds' tuning sentences together. Its gain less that of held_out_scores is the gap.
Scores inner_scores(const Tuning& tuning);

// What to make of it: "better", "worse" or "no difference" on held-out sentences, p under 0.05.
enum class TuningVerdict { better, worse, no_difference };
TuningVerdict verdict_of(const Tuning& tuning);
std::string_view verdict_sentence(TuningVerdict verdict);

// The mean of what is there; nothing where nothing is.
std::optional<double> mean_of(const SentenceValues& values);

// A tuning as text for people, as JSON (corpora_schema/tuning.md), as one HTML page.
std::string tuning_text(const Tuning& tuning);
std::string tuning_json(const Tuning& tuning);
std::string tuning_html(const Tuning& tuning);

// The weights file: what `synth --weights` reads, and in members of its own (x-...) what it is
// tuned to.
std::string tuned_weights_file(const Tuning& tuning);

} // namespace phonomime
