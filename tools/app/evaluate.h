// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "tools/app/import_corpus.h"
#include "tools/app/synth.h"
#include "tools/evaluate/aggregate.h"
#include "tools/evaluate/compare.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// How near to recordings is what Phonomime makes of their transcripts?
struct EvaluateOptions {
  ImportOptions import;   // corpus; with folds also rate, PCA and how recordings are read
  SynthOptions synth;     // weights, silence, smoothing, threads; outputs: .html .json .csv .txt;
                          // database: evaluates the sentences that it does not hold; empty: folds
  int folds = 0;          // 2 to 100 without a database: k-fold by sentence within the corpus
  std::uint64_t seed = 1; // of the lots by which folds, samples and parts are drawn
  int fold = 0;           // only this one, from 1; 0: all
  int sentences = 0;      // at most so many, by lot; 0: all. Training data stay as they are
  std::vector<std::string>
      methods;                   // names of method_table(); empty: all. The first is the main one
  std::filesystem::path against; // JSON report of an earlier run to compare with
  bool sizes = false;            // the main method again with growing parts of the recordings
  bool emotions = false;         // whether the emotion that is asked for is recognised

  // Throws UsageError, which says what is out of range or does not go together.
  void validate() const;
};

struct EvaluateReport {
  Evaluation evaluation;
  std::optional<Comparison> comparison;
};

// Holds recordings out, has every method speak them with the others, measures, and writes every
// output, all or none. With folds each database is temporary and made by import_corpus from the
// fold's training sentences alone: its reference poses, its PCA and all that methods fit never see
// a held-out recording. Throws UsageError, InputError, IoError and Interrupted.
EvaluateReport run_evaluate(const EvaluateOptions& options, const Progress& progress);

} // namespace phonomime
