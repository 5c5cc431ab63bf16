// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/phoneme_set.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

inline constexpr double kLargestIntensity = 1.5;

// An emotion and how much of it: what a phoneme is asked to show.
struct EmotionModifier {
  std::string emotion = {};
  double intensity = 1.0; // 0 to kLargestIntensity; 1 = as recorded
  bool operator==(const EmotionModifier&) const = default;
};

// An emotion, or several together (T2.15); neutral is what is left of 1. No emotion twice, all
// intensities together at most kLargestIntensity.
struct EmotionMixture {
  EmotionModifier heaviest; // of most intensity, ties to the earlier
  std::vector<EmotionModifier> others = {};
  bool operator==(const EmotionMixture&) const = default;
};

// One line of an emotion track, half-open in time.
struct EmotionSpan {
  double start_s = 0.0;
  double end_s = 0.0;
  std::string emotion = {}; // of a mixture the heaviest
  double intensity = 1.0;   // 0 to kLargestIntensity; 1 = as recorded
  long line = 0;
  std::vector<EmotionModifier> others = {}; // of a mixture
};

// What a span asks for.
EmotionMixture mixture_of(const EmotionSpan& span);

// Spans in order of time, none overlapping.
struct EmotionTrack {
  std::string source; // path, for messages
  std::vector<EmotionSpan> spans;
};

// "happiness" or "happiness:0.6". Throws InputError.
EmotionModifier parse_emotion_modifier(std::string_view text, std::string_view where);

// The same, or "happiness:0.6+anger:0.3", as --emotion takes it. Throws InputError.
EmotionMixture parse_emotion_mixture(std::string_view text, std::string_view where);

// The text that gives the same mixture.
std::string format_emotions(const EmotionMixture& mixture);

// The track of a text file (corpora_schema/emotion_track.md). `where` names the file. Throws
// InputError with file and line: a malformed line, a reversed or overlapping span, an intensity out
// of range. Whether an emotion exists is the database's to say.
EmotionTrack parse_emotion_track(std::string_view text, std::string_view where);

// One emotion for each phoneme (DESIGN section 11): the one that covers most of it, all its spans
// taken together, ties to the earlier; `fallback` covers the time where the track is silent. The
// intensity is that of the emotion's longest piece in the phoneme, ties to the earlier.
std::vector<EmotionModifier> assign_emotions(const EmotionTrack& track,
                                             std::span<const TimedPhoneme> phonemes,
                                             const EmotionModifier& fallback);

} // namespace phonomime
