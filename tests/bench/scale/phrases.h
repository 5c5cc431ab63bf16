// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace phonomime::bench {

// What is to be said, as the search sees it.
struct Phrase {
  std::string name;
  double duration_s = 0.0; // from the first step to the last
  std::vector<SearchStep> steps;
};

// Transcripts timed by Festival (.lab), each in one emotion of the table, in turn.
std::vector<Phrase> read_phrases(const MotionTable& table,
                                 const std::vector<std::filesystem::path>& files);

// `count` transcripts of 30 to 60 phonemes made of runs of 3 to 8 from the table's own sentences,
// joined in random order, each in one emotion. Same arguments, same transcripts.
std::vector<Phrase> random_phrases(const MotionTable& table, int count, std::uint64_t seed);

} // namespace phonomime::bench
