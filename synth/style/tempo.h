// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "db/types/phoneme_set.h"
#include "synth/style/aligned_sentences.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

// How much longer an emotion's phonemes last than neutral ones (a gap that T 2.4 names).
struct EmotionTempo {
  double overall = 1.0;                                 // ratio of durations, all phonemes
  std::map<std::string, double, std::less<>> of_viseme; // by class of phoneme
  double pause = 1.0;                                   // of silence between phonemes
};

struct TempoModel {
  std::string neutral;
  std::map<std::string, EmotionTempo, std::less<>> emotions; // every style but neutral
};

// Of aligned phonemes: how long they last in the emotion, all together, by how long the same ones
// last in the reference. A class' ratio is drawn to the overall one as if kTempoPrior phonemes more
// of the class' mean duration, or of all phonemes' if that is longer, had that. Pauses, where both
// readings make one between the same phonemes, are a class of their own. Throws what
// align_sentences throws.
inline constexpr double kTempoPrior = 20.0;
TempoModel learn_tempo(const MotionTable& table, const TrainingOptions& options);

// A transcript that nobody has spoken yet at the tempo of its emotions: each phoneme, and each
// pause between phonemes, lasts 1 + intensity (ratio - 1) times as long (of a mixture the sum over
// its parts), later rows follow. Silence at the ends and what is neutral keep their duration.
// `emotions`: one for each row. Throws InputError for an emotion whose tempo was not learned, with
// those that were.
std::vector<TimedPhoneme> retime(std::span<const TimedPhoneme> rows,
                                 std::span<const EmotionMixture> emotions, const TempoModel& tempo);

// Where a time of the old rows is in the new ones: linear inside each row, moved with its
// neighbours before the first and after the last. `rows` and `retimed` are of equal number, and
// not empty.
double retimed_at(std::span<const TimedPhoneme> rows, std::span<const TimedPhoneme> retimed,
                  double time_s);

} // namespace phonomime
