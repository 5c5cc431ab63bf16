// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/evaluate/measures.h"

#include <string>
#include <utility>
#include <vector>

namespace phonomime {

// A sentence that the report shows frame by frame.
struct ShownSentence {
  std::string key;
  std::string text;
  std::vector<TimedPhoneme> rows;
  double rate_hz = 0.0;
  FrameMatrix recorded;                     // #frames by #channels
  std::vector<SynthesisedSentence> methods; // in the order offered
  double error = 0.0;                       // of the main method
  bool worst = false;                       // shown for being among the worst, else by lot
};

// Keeps the motion of the few sentences that the report shows: the worst of the main method and a
// sample by lot (the smallest hashes of their keys), whatever the order in which they are offered.
// The memory held is bounded by the counts. Not safe against calls from several threads at once.
class Showcase {
public:
  Showcase(std::string main_method, int worst_count, int sample_count);

  // The recording and what the methods made of it; `error` is the main method's squared error
  // (E13), nothing where it has none. Motion is copied only where it is kept.
  void offer(const MeasureSetup& setup, const ImportedSentence& recorded,
             const std::vector<SynthesisedSentence>& methods, std::optional<double> error);

  // Worst first, then the sample in order of key; no sentence twice.
  std::vector<ShownSentence> shown() const;

  const std::string& main_method() const { return main_method_; }

private:
  std::string main_method_;
  std::size_t worst_count_, sample_count_;
  std::vector<ShownSentence> worst_, sample_;
};

} // namespace phonomime
