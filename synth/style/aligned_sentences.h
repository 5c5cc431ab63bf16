// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <cstdint>
#include <string>
#include <vector>

namespace phonomime {

inline constexpr const char* kNeutral = "neutral";

struct TrainingOptions {
  // Emotions, each to be a style; empty: every emotion in which the table has nodes, in its order.
  std::vector<std::string> styles;
  std::string reference = kNeutral; // the style whose timing the columns have; one of the styles
  int parts = 5;                    // of a cross-validation; a sentence is in one of them alone
};

// A sentence, or nodes of it, that a training could not use, and why.
struct NotAligned {
  std::string sentence; // its id
  std::string reason;
};

// One sentence in one style: its nodes, in order of time.
using Reading = std::vector<const MotionNode*>;

struct AlignedSentence {
  std::string id;
  std::vector<Reading> readings; // one a style
  // For each reference node that every style says: that node, and each other style's.
  std::vector<Reading> nodes;
};

// What a table has of the same speech in several styles.
struct AlignedSentences {
  std::vector<std::string> styles;        // the reference first
  std::vector<AlignedSentence> sentences; // in order of id
  std::int64_t nodes = 0;                 // of the reference, aligned with every style
  std::int64_t nodes_left_out = 0;        // of the reference, in those sentences, not aligned
  std::vector<NotAligned> not_aligned;    // in order of sentence
};

// Sentences of the same id, aligned by their phonemes (align_phonemes). Points into `table`. Throws
// InputError: a style that the table does not have, a reference that is none of the styles, fewer
// than two styles, no sentence in all of them.
AlignedSentences align_sentences(const MotionTable& table, const TrainingOptions& options);

} // namespace phonomime
