// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/corpus.h"
#include "db/types/imported_sentence.h"
#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "tools/app/import_corpus.h"
#include "tools/evaluate/measure_table.h"
#include "tools/evaluate/method.h"
#include "tools/tune/journal.h"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace phonomime {

// Sentences (keys) that are spoken, and those that they are spoken with; no sentence is both, nor
// are two emotions of one text.
struct TunePart {
  std::set<std::string> training;
  std::set<std::string> spoken;
};

// What one evaluation speaks.
struct TuneSetPlan {
  std::string name; // as the journal has it
  int fold = 0;     // of whose sentences it must not know (inner), or which it speaks; 0: none
  bool inner = true;
  std::vector<TunePart> parts;
};

struct TuneLots {
  int folds = 5, inner = 3, sentences = 24, held_out = 0; // as in TuneOptions
  std::uint64_t seed = 1;
};

// The inner set of each outer fold, then that of all the corpus, then the held-out set of each
// outer fold. Throws InputError where the corpus has too few sentences.
std::vector<TuneSetPlan> plan_tune_sets(const Corpus& corpus, const TuneLots& lots);

// How motion is made, whatever the weights.
struct TuneMethod {
  CostModel cost = CostModel::context;
  int blend = 1;
  ConcatOptions concat;
  Measure objective = Measure::squared_error;
};

// A set as it is kept over all evaluations.
class TuneSet {
public:
  // Imports and reads what the plan says (hold_out). Notes say which sentences were faulty.
  TuneSet(const TuneSetPlan& plan, const ImportOptions& import, const TuneMethod& method,
          const Progress& progress);

  const std::string& name() const { return name_; }
  std::vector<std::string> keys() const; // of the sentences, as spoken
  const std::vector<std::string>& notes() const { return notes_; }
  LayoutKind kind() const { return parts_.front().tables.begin()->second.layout.kind; }
  CostWeights shipped() const; // with PNT 0: all else is the same for every database

  // The measure of each sentence. PNT is each database's own. Several threads may call at a time.
  // Throws Interrupted.
  SentenceValues speak(const CostWeights& weights, const Progress& progress) const;

private:
  struct Part {
    std::map<std::string, MotionTable> tables; // by speaker
    std::map<std::string, double> pnt;
    std::vector<ImportedSentence> sentences;
  };

  std::string name_;
  TuneMethod method_;
  std::vector<Part> parts_;
  std::vector<std::string> notes_;
};

} // namespace phonomime
