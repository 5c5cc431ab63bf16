// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/transcript_steps.h"

#include "db/types/errors.h"
#include "db/types/row_frames.h"
#include "db/types/text.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

std::size_t constrained_row(const NodeConstraint& constraint,
                            std::span<const TimedPhoneme> transcript) {
  if (constraint.index) {
    const long index = *constraint.index;
    if (index < 0 || index >= static_cast<long>(transcript.size())) {
      throw InputError({.where = constraint.where,
                        .what = "the transcript has no such row",
                        .expected = fmt::format("0 to {}", transcript.size() - 1),
                        .got = fmt::format("{}", index)});
    }
    return static_cast<std::size_t>(index);
  }
  const double time = *constraint.time_s;
  for (std::size_t row = 0; row < transcript.size(); ++row) {
    if (transcript[row].start_s <= time && time < transcript[row].end_s) {
      return row;
    }
  }
  throw InputError({.where = constraint.where,
                    .what = "the time is outside the transcript",
                    .expected = fmt::format("{} to {} s", format_number(transcript.front().start_s),
                                            format_number(transcript.back().end_s)),
                    .got = format_number(time) + " s"});
}

std::vector<RowConstraint> constraints_per_row(const MotionTable& table,
                                               std::span<const TimedPhoneme> transcript,
                                               std::span<const NodeConstraint> constraints,
                                               std::vector<std::string>& warnings) {
  std::vector<RowConstraint> rows(transcript.size());
  for (const NodeConstraint& constraint : constraints) {
    const std::size_t row = constrained_row(constraint, transcript);
    add_constraint(table, constraint, row, transcript[row], rows[row], warnings);
  }
  return rows;
}

// Surroundings of the rows of a transcript that are no silence; the others' stay empty. Times are
// those of the frames that rows get, as nodes' are: a recorded sentence finds itself.
std::vector<Surroundings> asked_surroundings(const MotionTable& table,
                                             std::span<const TimedPhoneme> transcript) {
  const double frame_s = 1.0 / table.rate_hz;
  const std::vector<FrameRange> ranges = row_frames(transcript, table.rate_hz);
  std::vector<SpokenPhoneme> utterance;
  for (std::size_t row = 0; row < transcript.size(); ++row) {
    if (!transcript[row].is_silence()) {
      const auto first = static_cast<double>(ranges[row].first);
      const auto end = static_cast<double>(ranges[row].end());
      utterance.push_back({first * frame_s, end * frame_s,
                           table.find_phoneme(transcript[row].phoneme.name).value_or(-1)});
    }
  }
  std::vector<Surroundings> surroundings(transcript.size());
  std::size_t spoken = 0;
  for (std::size_t row = 0; row < transcript.size(); ++row) {
    if (!transcript[row].is_silence()) {
      surroundings[row] = surroundings_of(utterance, spoken++, 0.5 * frame_s);
      surroundings[row].duration_s = static_cast<double>(ranges[row].count) / table.rate_hz;
    }
  }
  return surroundings;
}

} // namespace

std::int32_t find_asked_emotion(const MotionTable& table, const EmotionModifier& asked,
                                std::string_view where) {
  const std::optional<std::int32_t> emotion = table.find_emotion(asked.emotion);
  if (!emotion) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("emotion {} is not in the database's recordings of {}",
                                          quoted(asked.emotion), table.speaker),
                      .expected = fmt::format("one of {}", fmt::join(table.emotions, ", ")),
                      .remedy = did_you_mean(asked.emotion, table.emotions)});
  }
  return *emotion;
}

SearchStep make_search_step(const MotionTable& table, const Phoneme& phoneme,
                            const EmotionModifier& emotion, RowConstraint constraint) {
  SearchStep step;
  step.is_silence = phoneme.name == kSilence;
  step.phoneme = table.find_phoneme(phoneme.name).value_or(-1);
  step.viseme = table.find_viseme(phoneme.viseme).value_or(-1);
  step.emotion = find_asked_emotion(table, emotion, "");
  if (constraint.use) {
    step.allowed = std::move(*constraint.use);
  }
  step.avoided = std::move(constraint.avoid);
  return step;
}

void UnrecordedPhonemes::warn_of(const Phoneme& phoneme, const SearchStep& step,
                                 std::vector<std::string>& warnings) {
  if (step.is_silence || seen_.contains(phoneme.name)) {
    return;
  }
  seen_.insert(phoneme.name);
  const bool recorded = std::ranges::any_of(
      table_.nodes, [&](const MotionNode& node) { return node.phoneme == step.phoneme; });
  if (!recorded) {
    warnings.push_back(fmt::format(
        "/{}/ was never recorded: a phoneme of its viseme, or another, stands in", phoneme.name));
  }
}

TranscriptSteps make_transcript_steps(const MotionTable& table,
                                      std::span<const TimedPhoneme> transcript,
                                      std::span<const EmotionModifier> emotions,
                                      std::span<const NodeConstraint> constraints) {
  TranscriptSteps result;
  if (transcript.empty()) {
    throw InputError({.what = "the transcript has no phonemes"});
  }
  std::vector<RowConstraint> rows =
      constraints_per_row(table, transcript, constraints, result.warnings);
  const auto takes_node = [&](std::size_t row) {
    return !transcript[row].is_silence() || rows[row].use.has_value();
  };
  std::size_t first = 0;
  std::size_t end = transcript.size();
  while (first < end && !takes_node(first)) {
    ++first;
  }
  while (end > first && !takes_node(end - 1)) {
    --end;
  }
  result.first_row = first;
  UnrecordedPhonemes unrecorded(table);
  const std::vector<Surroundings> surroundings = asked_surroundings(table, transcript);
  for (std::size_t row = first; row < end; ++row) {
    const Phoneme& phoneme = transcript[row].phoneme;
    result.used.push_back(rows[row].use.has_value());
    result.steps.push_back(make_search_step(table, phoneme, emotions[row], std::move(rows[row])));
    result.steps.back().surroundings = surroundings[row];
    unrecorded.warn_of(phoneme, result.steps.back(), result.warnings);
  }
  return result;
}

} // namespace phonomime
