// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/synth_inputs.h"

#include "db/import/readers.h"
#include "db/types/emotion_track.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/node_constraint.h"
#include "db/types/text.h"
#include "synth/pipeline/transcript_steps.h"
#include "synth/search/cost_weights.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kLongestTranscript_s = 7200.0;

// Lest a slip in a file's times ask for more memory than there is.
void check_length(const Alignment& alignment) {
  for (const AlignedLabel& row : alignment.rows) {
    if (row.end_s > kLongestTranscript_s) {
      throw InputError(
          {.where = row.line > 0 ? at_line(alignment.source, row.line) : alignment.source,
           .what = "the transcript is too long",
           .expected = fmt::format("an end at {} s at the latest", kLongestTranscript_s),
           .got = format_number(row.end_s) + " s",
           .remedy = "Check the unit of its times, or cut it into parts."});
    }
  }
}

std::vector<std::string> sets_to_try(const MotionTable& table) {
  const std::vector<std::string> built_in = PhonemeSet::built_in_names();
  std::vector<std::string> names;
  for (const std::vector<std::string>& source : {table.phoneme_sets, built_in}) {
    for (const std::string& name : source) {
      const bool known = std::ranges::find(built_in, name) != built_in.end();
      if (known && std::ranges::find(names, name) == names.end()) {
        names.push_back(name);
      }
    }
  }
  return names;
}

// The set asked for; else the first that knows every symbol, the database's own before the others.
PhonemeSet choose_phoneme_set(const SynthOptions& options, const MotionTable& table,
                              const Alignment& alignment) {
  if (!options.phoneme_set.empty()) {
    return options.phoneme_set.ends_with(".json")
               ? PhonemeSet::parse(read_file(options.phoneme_set), options.phoneme_set)
               : PhonemeSet::built_in(options.phoneme_set);
  }
  const std::vector<std::string> names = sets_to_try(table);
  for (const std::string& name : names) {
    PhonemeSet set = PhonemeSet::built_in(name);
    if (std::ranges::all_of(alignment.rows,
                            [&](const AlignedLabel& row) { return set.find(row.label) >= 0; })) {
      return set;
    }
  }
  return PhonemeSet::built_in(names.front()); // to_phonemes names the first unknown symbol
}

std::vector<EmotionModifier> read_emotions(const SynthOptions& options, const MotionTable& table,
                                           const std::vector<TimedPhoneme>& transcript) {
  const EmotionModifier fallback = options.emotion.empty()
                                       ? EmotionModifier{.emotion = "neutral"}
                                       : parse_emotion_modifier(options.emotion, "--emotion");
  EmotionTrack track;
  if (!options.emotions.empty()) {
    track = parse_emotion_track(read_file(options.emotions), options.emotions.string());
  }
  for (const EmotionSpan& span : track.spans) {
    find_asked_emotion(table, {.emotion = span.emotion, .intensity = span.intensity},
                       at_line(track.source, span.line));
  }
  if (!options.emotion.empty()) {
    find_asked_emotion(table, fallback, "--emotion");
  }
  return assign_emotions(track, transcript, fallback);
}

} // namespace

SynthesisInput read_synthesis_input(const SynthOptions& options, const MotionTable& table,
                                    const CostWeights& default_weights,
                                    std::vector<std::string>& notes) {
  SynthesisInput input;
  const Alignment alignment = read_alignment(options.transcript, {.tier = options.tier});
  check_length(alignment);
  const PhonemeSet set = choose_phoneme_set(options, table, alignment);
  if (options.phoneme_set.empty()) {
    notes.push_back(
        fmt::format("read {} with phoneme set {}", options.transcript.string(), set.name()));
  }
  input.transcript = to_phonemes(alignment, set);
  if (input.transcript.empty()) {
    throw InputError({.where = options.transcript.string(), .what = "the transcript is empty"});
  }
  input.emotions = read_emotions(options, table, input.transcript);
  if (!options.constraints.empty()) {
    input.constraints =
        parse_constraints(read_file(options.constraints), options.constraints.string());
  }
  input.weights = default_weights;
  if (!options.weights.empty()) {
    input.weights =
        parse_cost_weights(read_file(options.weights), options.weights.string(), input.weights);
  }
  input.search = {.threads = options.threads, .runners_up = options.runners_up};
  input.concat = {.silence = options.silence,
                  .smoothing_half_window = options.smoothing_half_window};
  input.fps = options.fps;
  return input;
}

} // namespace phonomime
