// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/motion_database.h"

#include <cstdint>
#include <string>
#include <vector>

namespace phonomime::test {

inline constexpr double kRate_hz = 100.0;

// A layout of `markers` markers called m0, m1, ...
Layout made_layout(int markers = 4);

// Silence and six phonemes of three visemes.
std::vector<Phoneme> made_phonemes();

// A sentence of seeded random motion: /pau/, five phonemes, sometimes an inner /pau/, /pau/. Every
// frame of a phoneme is in its node.
ImportedSentence made_sentence(const std::string& speaker, const std::string& emotion,
                               const std::string& id, std::uint64_t seed, int markers = 4,
                               int frames = 60);

// A model with an orthonormal basis that is not any axis', of `dimensions` dimensions.
PcaModel made_pca(Eigen::Index channels, Eigen::Index dimensions, std::uint64_t seed = 7);

struct MadeCorpus {
  std::string name = "made";
  std::vector<ImportedSentence> sentences;
  Eigen::Index dimensions = 5;
  std::uint64_t pca_seed = 7;
};

// `count` sentences of speaker s1 in two emotions; `name` goes into their ids.
MadeCorpus made_corpus(const std::string& name, int count, int markers = 4, int frames = 60);

// Imports as the program does: phonemes, sentences, reference poses, PCA, commit.
void import_corpus(MotionDatabase& database, const MadeCorpus& corpus);

} // namespace phonomime::test
