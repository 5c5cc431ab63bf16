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
#include "tools/app/retime.h"
#include "tools/app/synth_outputs.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

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

// The first set that knows every symbol.
PhonemeSet choose_phoneme_set(const SynthOptions& options, const MotionTable& table,
                              const Alignment& alignment) {
  std::vector<PhonemeSet> sets = phoneme_sets_to_try(options, table);
  const auto knows_all = [&](const PhonemeSet& set) {
    return std::ranges::all_of(alignment.rows,
                               [&](const AlignedLabel& row) { return set.find(row.label) >= 0; });
  };
  const auto chosen = std::ranges::find_if(sets, knows_all);
  // Where none does, to_phonemes names the first symbol that the first set does not know.
  return std::move(chosen == sets.end() ? sets.front() : *chosen);
}

// The parts that do anything: neutral is what is left of 1 anyway, and so is an emotion of
// intensity 0.
EmotionMixture without_neutral(const EmotionMixture& mixture) {
  EmotionMixture kept{.heaviest = {.emotion = "neutral"}};
  std::vector<EmotionModifier> parts = mixture.others;
  parts.insert(parts.begin(), mixture.heaviest);
  std::erase_if(parts, [&](const EmotionModifier& part) {
    return part.intensity == 0.0 || part.emotion == kept.heaviest.emotion;
  });
  if (!parts.empty()) { // the heaviest is first, or was neutral
    const auto heaviest = std::ranges::max_element(parts, {}, &EmotionModifier::intensity);
    kept.heaviest = *heaviest;
    parts.erase(heaviest);
    kept.others = std::move(parts);
  }
  return kept;
}

} // namespace

std::vector<PhonemeSet> phoneme_sets_to_try(const SynthOptions& options, const MotionTable& table) {
  if (options.phoneme_set.ends_with(".json")) {
    return {PhonemeSet::parse(read_file(options.phoneme_set), options.phoneme_set)};
  }
  std::vector<PhonemeSet> sets;
  for (const std::string& name :
       options.phoneme_set.empty() ? sets_to_try(table) : std::vector{options.phoneme_set}) {
    sets.push_back(PhonemeSet::built_in(name));
  }
  return sets;
}

AskedEmotions read_asked_emotions(const SynthOptions& options) {
  AskedEmotions asked;
  if (!options.emotion.empty()) {
    asked.fallback = without_neutral(parse_emotion_mixture(options.emotion, "--emotion"));
    asked.fallback_given = true;
  }
  if (!options.emotions.empty()) {
    asked.track = parse_emotion_track(read_file(options.emotions), options.emotions.string());
  }
  for (EmotionSpan& span : asked.track.spans) {
    EmotionMixture mixture = without_neutral(mixture_of(span));
    span.emotion = mixture.heaviest.emotion;
    span.intensity = mixture.heaviest.intensity;
    span.others = std::move(mixture.others);
  }
  return asked;
}

ReadTranscript read_transcript(const SynthOptions& options, const MotionTable& table) {
  const Alignment alignment = read_alignment(options.transcript, {.tier = options.tier});
  check_length(alignment);
  const PhonemeSet set = choose_phoneme_set(options, table, alignment);
  ReadTranscript transcript{.rows = to_phonemes(alignment, set), .phoneme_set = set.name()};
  if (transcript.rows.empty()) {
    throw InputError({.where = options.transcript.string(), .what = "the transcript is empty"});
  }
  return transcript;
}

std::vector<NodeConstraint> read_constraints(const SynthOptions& options) {
  return options.constraints.empty()
             ? std::vector<NodeConstraint>()
             : parse_constraints(read_file(options.constraints), options.constraints.string());
}

CostWeights read_weights(const SynthOptions& options, const CostWeights& default_weights) {
  return options.weights.empty() ? default_weights
                                 : parse_cost_weights(read_file(options.weights),
                                                      options.weights.string(), default_weights);
}

ConcatOptions concat_options(const SynthOptions& options) {
  return {.silence = options.silence, .smoothing_half_window = options.smoothing_half_window};
}

SynthesisInput read_synthesis_input(const SynthOptions& options, const MotionTable& table,
                                    const CostWeights& default_weights, AskedEmotions& emotions,
                                    std::vector<std::string>& notes) {
  SynthesisInput input;
  ReadTranscript transcript = read_transcript(options, table);
  if (options.phoneme_set.empty()) {
    notes.push_back(fmt::format("read {} with phoneme set {}", options.transcript.string(),
                                transcript.phoneme_set));
  }
  input.transcript = std::move(transcript.rows);
  emotions = read_asked_emotions(options);
  input.emotions = assign_emotions(emotions.track, input.transcript, emotions.fallback.heaviest);
  input.constraints = read_constraints(options);
  if (options.retime) {
    retime_input(table, input, emotions, notes);
  }
  input.weights = read_weights(options, default_weights);
  input.blend = options.blend.value_or(kUsualBlend);
  input.search = {.threads = options.threads,
                  .runners_up = tells_runners_up(options) ? options.runners_up : 0};
  input.concat = concat_options(options);
  input.fps = options.fps;
  return input;
}

} // namespace phonomime
