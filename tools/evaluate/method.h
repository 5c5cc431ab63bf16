// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "synth/concat/concatenate.h"
#include "synth/search/search_types.h"
#include "tools/evaluate/measures.h"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// What a method is made from: the training recordings of one speaker, and how it is to synthesise.
struct MethodContext {
  const MotionTable& table;  // outlives the method
  CostWeights weights;       // of the search as it is by default
  CostWeights paper_weights; // of the paper's cost
  int blend = 1;             // paths, by default
  ConcatOptions concat;
  int threads = 1;         // for what it fits
  std::size_t workers = 1; // threads that will call it at the same time
};

// A held-out sentence as a method gets to know it.
struct SentenceRequest {
  std::span<const TimedPhoneme> rows; // from 0 on, without holes
  std::string_view emotion;
  Eigen::Index frame_count = 0;          // of the motion, at the table's rate
  const FrameMatrix* recorded = nullptr; // #frames by #channels; only for who sees_recording
};

struct MethodAnswer {
  SynthesisedSentence sentence; // without its method's name
  double search_s = 0.0;        // wall clock of the search, where there is one
};

// A way to make motion of a transcript. What it has fitted is fixed when it has been made.
class Method {
public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  // Several threads may call at a time, each with a `worker` of its own below
  // MethodContext::workers; the answer depends on neither. Throws InputError for an emotion that
  // the table does not know, and Interrupted.
  virtual MethodAnswer say(const SentenceRequest& request, std::size_t worker,
                           const Progress& progress) = 0;
};

// A row of the table of methods.
struct MethodEntry {
  std::string_view name;
  std::string_view meaning;    // one clause for people
  bool sees_recording = false; // the oracle, and nobody else
  std::unique_ptr<Method> (*make)(const MethodContext& context, const Progress& progress);
};

// Every method, in the order of the reports' tables.
std::span<const MethodEntry> method_table();

// The entries of these names, in their order; all of them where there is no name. Throws UsageError
// for an unknown or repeated name, with the nearest ones.
std::vector<MethodEntry> find_methods(std::span<const std::string> names);

} // namespace phonomime
