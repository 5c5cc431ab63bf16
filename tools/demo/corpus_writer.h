// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/demo/mask_face.h"

namespace phonomime::demo {

// A sentence to speak: one line of sentences.txt.
struct Sentence {
  std::string id;
  std::string text;
};

// The lines "id<TAB>text" of a sentence list; empty lines and lines that begin with # are skipped.
// Throws InputError.
std::vector<Sentence> parse_sentences(std::string_view text, std::string_view where);

inline constexpr std::uint64_t kDefaultSeed = 2008;
inline constexpr std::string_view kSpeaker = "demo";

struct CorpusJob {
  std::filesystem::path speech; // folder: <emotion>/<id>.wav and <emotion>/<id>.lab, by Festival
  std::filesystem::path out;    // folder to make
  std::vector<Sentence> sentences;
  FaceModel face;
  std::uint64_t seed = kDefaultSeed;
};

struct CorpusReport {
  int sentences = 0; // in all emotions
  long frames = 0;
  int contaminated = 0;  // sentences
  int with_dropouts = 0; // sentences
};

// Makes the corpus folder whole or not at all; an earlier demo corpus at `out` is replaced,
// anything else there is an error. The same job gives the same bytes. Throws InputError and
// IoError.
CorpusReport write_corpus(const CorpusJob& job);

} // namespace phonomime::demo
