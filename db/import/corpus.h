// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/readers.h"
#include "db/types/layout.h"
#include "db/types/phoneme_set.h"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// A sentence of a corpus, its files found.
struct CorpusSentence {
  std::string id;
  std::string text; // may be empty
  std::string speaker;
  std::string emotion;
  std::filesystem::path motion; // canonical, inside the corpus folder, as are the others
  std::filesystem::path alignment;
  std::filesystem::path audio; // may be empty
  std::string motion_name;     // as the table writes it
  std::string alignment_name;
  std::optional<double> start_s; // cuts the sentence out of longer files, on their clock
  std::optional<double> end_s;
  std::string where; // "sentences.tsv:12"
};

// The frame that a corpus names as a speaker's reference pose.
struct ReferenceFrame {
  std::size_t sentence = 0; // into Corpus::sentences
  double time_s = 0.0;      // on the sentence's clock
};

// A corpus folder as its three files describe it (DESIGN 9). Nothing of the recordings is read yet.
struct Corpus {
  std::filesystem::path folder; // canonical
  std::string name;
  bool synthetic = false; // says that it was made, not recorded
  PhonemeSet phoneme_set;
  Layout layout;
  std::vector<CorpusSentence> sentences;                  // in the table's order
  std::map<std::string, ReferenceFrame> reference_frames; // by speaker
  AlignmentOptions alignment_options;
};

// Reads corpus.json, the layout and the sentence table, and finds every file that they name. A
// sentence without a speaker is the speaker named as the corpus, one without an emotion is neutral;
// time 0 of a motion file is its first frame, whatever its own clock says.
// Throws InputError (file and line) and IoError.
Corpus read_corpus(const std::filesystem::path& folder);

// Which sentences of a corpus; empty: every one.
using SentenceFilter = std::function<bool(const CorpusSentence&)>;

// Leaves out the sentences that the filter does not take, as if the table had never named them: a
// reference frame in one of them is forgotten, so that the speaker's pose is found as where none is
// named. Throws InputError where no sentence is left.
void keep_sentences(Corpus& corpus, const SentenceFilter& takes);

} // namespace phonomime
