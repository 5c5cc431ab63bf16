// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "tools/app/synth.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// What to put into a constraint file for one row of a transcript (E section VI-A).
struct RecommendOptions {
  SynthOptions synth;           // as for synth; outputs, face, audio and blend are not used
  std::optional<long> row;      // of the transcript, counted from 0, silence too
  std::optional<double> time_s; // instead: the row that is spoken then, and how far it is
  double relative_time = 0.5;   // in the row, 0 to 1: what nodes are to look like then
  int limit = 10;               // recommendations, 1 to 1000
};

// A node for the row.
struct Recommendation {
  std::string node;             // key
  NodeIndex index = kNoNode;    // into the speaker's table
  bool context_correct = false; // recorded between the same phonemes
  bool chosen = false;          // the best path has it
  double delta = 0.0;           // what the best path through it costs more than the best
  std::string previous, phoneme, next, emotion; // as it was recorded
  std::int32_t frames = 0;
  double frame = 0.0;                         // at the relative time, between two of its frames
  std::optional<double> aperture_mm;          // then
  std::optional<std::array<double, 2>> place; // then, on the phoneme-Isomap, where a fresh one is
};

struct RecommendReport {
  long row = 0;
  std::string previous, phoneme, next; // asked for
  double start_s = 0.0, end_s = 0.0;
  std::string emotion; // asked for
  double relative_time = 0.0;
  double cost = 0.0;                // of the best path
  std::int64_t context_correct = 0; // nodes that may be used
  std::vector<Recommendation> recommended;
  std::vector<std::string> notes, warnings;
};

// The nodes for a row, exactly ranked: those of the same triphone first, then by what the best path
// through them costs. All constraints hold, but for `use` on the row itself. Throws UsageError,
// InputError, IoError and Interrupted.
RecommendReport recommend_nodes(const RecommendOptions& options, const Progress& progress);

} // namespace phonomime
