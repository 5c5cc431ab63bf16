// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "db/types/motion_table.h"
#include "db/types/node_constraint.h"
#include "db/types/phoneme_set.h"
#include "synth/pipeline/synthesize.h"
#include "tools/app/synth.h"

#include <string>
#include <vector>

namespace phonomime {

// What phonemes are asked to show: the track's emotions, and one where it is silent.
struct AskedEmotions {
  EmotionTrack track;
  EmotionMixture fallback{.heaviest = {.emotion = "neutral"}};
  bool fallback_given = false; // by --emotion
};
// An emotion of intensity 0 is neutral. Whether the emotions are recorded is not looked at. Throws
// InputError and IoError.
AskedEmotions read_asked_emotions(const SynthOptions& options);

// The request as the recipe takes it, read from the files that `options` names; `default_weights`
// hold where those say nothing else. `emotions` are those of the request: the search asks for the
// heaviest part of a mixture, and what becomes of it is plan_style's. `notes` gets a line for each
// choice made for the user. Throws InputError and IoError.
SynthesisInput read_synthesis_input(const SynthOptions& options, const MotionTable& table,
                                    const CostWeights& default_weights, AskedEmotions& emotions,
                                    std::vector<std::string>& notes);

// Parts of it, for a transcript that is still to come.

inline constexpr double kLongestTranscript_s = 7200.0;

// The alphabet that `options` names, else those that a transcript may be written in, the
// database's own before the others.
std::vector<PhonemeSet> phoneme_sets_to_try(const SynthOptions& options, const MotionTable& table);

// The transcript that `options` names, in the alphabet that it names or the first that knows every
// symbol. Throws InputError and IoError.
struct ReadTranscript {
  std::vector<TimedPhoneme> rows;
  std::string phoneme_set;
};
ReadTranscript read_transcript(const SynthOptions& options, const MotionTable& table);

// How much longer a transcript may be than a motion that says it.
inline constexpr double kTranscriptTolerance_s = 0.1;

std::vector<NodeConstraint> read_constraints(const SynthOptions& options);
CostWeights read_weights(const SynthOptions& options, const CostWeights& default_weights);
ConcatOptions concat_options(const SynthOptions& options);

} // namespace phonomime
