// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "tools/app/import_corpus.h"
#include "tools/app/synth.h"
#include "tools/tune/many_starts.h"
#include "tools/tune/tuning.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

// Which weights of the cost bring syntheses nearest to recordings?
struct TuneOptions {
  ImportOptions import;          // corpus; rate, PCA and how recordings are read
  SynthOptions synth;            // cost, paths to blend, silence, smoothing, threads
  int folds = 5;                 // outer: each is held out of a tuning of its own, 2 to 100
  int inner = 3;                 // of each tuning: each is spoken with the others, 2 to 100
  int sentences = 24;            // spoken in each evaluation, by lot, at least `inner`
  int held_out = 0;              // at most so many of each outer fold, by lot; 0: all
  int starts = 16;               // 0 to 10000, as ManyStarts has them
  int descents = 2;              // 1 to 1000
  int evaluations = 30;          // 1 to 100000
  std::uint64_t seed = 1;        // of the lots by which folds, sentences and starts are drawn
  double time_limit_min = 0.0;   // after which no evaluation of the search begins; 0: none
  std::string objective = "e13"; // that or the id of a measure
  std::vector<std::string> only; // weights; empty: the usual ones
  std::filesystem::path journal; // empty: none is kept
  std::filesystem::path output;  // weights file
  std::vector<std::filesystem::path> reports; // .html .json .txt

  // Throws UsageError, which says what is out of range or does not go together.
  void validate() const;
};

// The measure that a name stands for. Throws UsageError where it is none that can be made better.
Measure tune_objective(const std::string& name);

struct TuneReport {
  Tuning tuning;
  std::size_t found = 0; // evaluations that the journal held from the start
};

// Tunes the weights to the whole corpus and, to know what that is worth, once more without each
// fold, whose sentences are then spoken with the shipped and the tuned weights. An evaluation is a
// mean over some sentences, each spoken with recordings of the other inner folds alone. Writes the
// weights file and the reports, all or none. The same call gives the same bytes, with any number of
// threads, from a journal or not, unless the time limit ends the search. Throws UsageError,
// InputError, IoError and Interrupted; the journal keeps what has been evaluated.
TuneReport run_tune(const TuneOptions& options, const Progress& progress);

} // namespace phonomime
