// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/corpus.h"
#include "db/types/imported_sentence.h"
#include "synth/style/style_model.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace phonomime::test {

// One sentence of a held-out recording: its frames from the first phoneme to the last.
struct SpokenReading {
  FrameMatrixD channels;     // #frames by #channels
  FrameMatrixD coefficients; // #frames by #dimensions, by the training's PCA
  std::vector<PhonemeFrames> phonemes;
};

// How far a sentence of one emotion, changed to another, is from what was spoken in it.
struct PairError {
  std::string from, to;
  // Sums over frames and markers of squared distances, mm^2. A frame is compared with the place of
  // the same phoneme that is as far along, between two frames.
  struct Squares {
    double unchanged = 0.0;
    double mean_difference = 0.0; // the mean face of `to` less that of `from` added
    double regression = 0.0;      // PCA coefficients and a constant, least squares, a frame
    double ours = 0.0;            // MotionStyler: contacts are held too
  } squares;
  std::int64_t markers = 0; // of all frames

  void add(const PairError& other);
  double rms(double Squares::*method) const; // mm
};

struct LipFigures {
  double intensity = 0.0;
  // /p b m/ that ask to close, those that did, before and after.
  std::int64_t lips = 0, closed_before = 0, closed_after = 0;
  // /f v/, those inside the recordings' range of that phoneme, before and after; those outside
  // afterwards by more than the motion had been.
  std::int64_t teeth = 0, inside_before = 0, inside_after = 0, taken_out = 0;
  std::int64_t moved = 0, left = 0;      // contacts of both kinds
  std::vector<double> recorded, changed; // accelerations of every marker, mm/s^2

  void add(const LipFigures& other);
};

struct FoundStyles {
  Eigen::Index frames = 0;
  std::int64_t right = 0, windows = 0;
};

// A style model that was trained without some sentences of a corpus, and those sentences.
struct JudgedStyles {
  MotionTable table; // of the others alone: neither PCA nor model knows the sentences
  TrainedStyle trained;
  std::map<std::string, std::map<std::string, SpokenReading>> spoken; // by id and emotion

  // `takes`: what of the corpus is used at all; `held_out`: what of it is kept back.
  static JudgedStyles train(const std::filesystem::path& corpus, const SentenceFilter& takes,
                            const SentenceFilter& held_out, const StyleOptions& options);

  std::vector<PairError> pair_errors() const;         // every emotion to every other
  LipFigures lips(double intensity) const;            // every emotion to every one but neutral
  FoundStyles find_styles(Eigen::Index frames) const; // windows inside sentences, none overlapping
};

} // namespace phonomime::test
