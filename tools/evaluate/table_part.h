// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/imported_sentence.h"
#include "db/types/motion_table.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// A table with some of its sentences only, the rest as it is: same PCA, reference pose, phonemes
// and emotions. `keep`: #sentences, at least one true. Of a sentence's frames those from its first
// node to its last stay.
MotionTable part_of(const MotionTable& table, const std::vector<bool>& keep);

// How many of the phonemes that transcripts ask for, in a context, a table has recorded so. A
// phoneme's context is the one before and the one after it, /pau/ at the edges.
struct ContextCoverage {
  std::int64_t diphones = 0, diphones_recorded = 0; // pairs, the first and last with /pau/
  std::int64_t triphones = 0, triphones_recorded = 0;
  void add(const ContextCoverage& other);
};
ContextCoverage context_coverage(const MotionTable& table, std::span<const ImportedSentence> asked);

} // namespace phonomime
