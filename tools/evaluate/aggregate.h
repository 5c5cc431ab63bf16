// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "tools/evaluate/emotion_findings.h"
#include "tools/evaluate/measures.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

// What was evaluated and how. Free of paths and times, so that the same run gives the same bytes.
struct RunInfo {
  std::string corpus;      // names of the corpora, "a + b"
  std::string held_out_by; // for people: "5 folds by sentence, seed 1", "not in the database"
  int folds = 0;           // 0 = no folds: a given database
  std::uint64_t seed = 0;
  double rate_hz = 0.0;
  std::int64_t left_out = 0;                  // sentences of the corpus that were not evaluated
  std::map<std::string, std::string> options; // whatever else shapes the result, name -> value
  std::vector<std::string> notes;             // for people, one sentence each
};

// One method's results; sentences in order of key, the same ones in each method.
struct MethodResult {
  std::string id;              // "paper"
  std::string description;     // one clause for people
  bool sees_recording = false; // it bounds the others and is no rival of theirs
  std::vector<SentenceMeasures> sentences;
  std::vector<int> folds; // #sentences: the fold that held it out; empty without folds
};

// One measure over all sentences.
struct Summary {
  std::optional<double> mean;           // over sentences, of the sentence's value: the main figure
  std::optional<double> standard_error; // of that mean; from two sentences on
  std::int64_t sentences = 0;           // that have a value
  std::optional<double> pooled;         // of the sums of all sentences
};

// A method's tables.
struct MethodTables {
  std::vector<MeasureValues> sentences;        // #sentences
  std::array<Summary, kMeasureCount> all = {}; // by measure
  std::map<std::string, std::array<Summary, kMeasureCount>> by_emotion;
  std::map<std::string, MeasureValues> by_phoneme; // pooled over its frames and rows
  std::map<std::string, std::int64_t> phoneme_frames;
  std::vector<std::optional<double>> marker_rmse;            // #groups; mm, pooled
  std::array<std::optional<double>, 8> region_rmse = {};     // by Region; mm, pooled
  std::map<int, std::array<Summary, kMeasureCount>> by_fold; // empty without folds
  double total_error = 0.0;                                  // E12
  const Summary& operator[](Measure measure) const {
    return all[static_cast<std::size_t>(measure)];
  }
};

// One size of database of `--sizes`.
struct SizePoint {
  std::int64_t sentences = 0; // in the database
  std::int64_t nodes = 0;
  double diphone_coverage = 0.0; // share of the held-out transcripts' diphones that are in it
  double triphone_coverage = 0.0;
  double search_s = 0.0; // mean over sentences (a timing: not the same in each run)
  std::array<Summary, kMeasureCount> quality = {};
};

// An evaluation with its tables.
struct Evaluation {
  RunInfo run;
  Layout layout;
  std::vector<MethodResult> methods; // in the order of the tables
  std::vector<MethodTables> tables;  // #methods
  std::map<std::string, ContactRange> contact_ranges;
  std::vector<SizePoint> sizes;
  std::optional<EmotionFindings> emotions;
  std::string main_method; // the one that the report shows frame by frame; empty: the first
};

// Judges the contacts of /f v/ by the ranges of the recordings themselves and fills `tables` and
// `contact_ranges`. Sentences are put in order of key first. Throws InternalError where methods
// hold other sentences, InputError where there is none.
void aggregate(Evaluation& evaluation);

// The parts of aggregate() for other sets of sentences, those of a size or of a fold: what the
// recordings say of contacts, the judgement by it (it replaces an earlier one), the summary.
std::map<std::string, ContactRange>
recorded_contact_ranges(std::span<const SentenceMeasures> sentences);
void judge_contacts(std::span<SentenceMeasures> sentences,
                    const std::map<std::string, ContactRange>& ranges);
std::array<Summary, kMeasureCount> summarise(std::span<const SentenceMeasures> sentences);

// Index into methods of Evaluation::main_method. Throws InternalError where there is none.
std::size_t main_method_index(const Evaluation& evaluation);

} // namespace phonomime
