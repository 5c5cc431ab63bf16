// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retime.h"

#include "synth/pipeline/asked_style.h"
#include "synth/style/tempo.h"
#include "tools/app/style_plan.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

bool is_transcript(const std::filesystem::path& path) {
  return path.extension() == ".lab";
}

// Adds an emotion's tempo, and a line for people, where it is not there yet. Each emotion by
// itself: another may have been recorded with other sentences.
void learn_tempo_of(const MotionTable& table, const std::string& emotion, TempoModel& tempo,
                    std::vector<std::string>& ratios) {
  if (emotion == tempo.neutral || tempo.emotions.contains(emotion)) {
    return;
  }
  if (!is_recorded(table, emotion)) {
    tempo.emotions[emotion] = {};
    ratios.push_back(fmt::format("{} 1 (never recorded)", emotion));
    return;
  }
  TempoModel learned = learn_tempo(table, {.styles = {tempo.neutral, emotion}});
  ratios.push_back(fmt::format("{} {:.2f}", emotion, learned.emotions[emotion].overall));
  tempo.emotions.merge(learned.emotions);
}

} // namespace

void retime_input(const MotionTable& table, SynthesisInput& input, AskedEmotions& asked,
                  std::vector<std::string>& notes) {
  const StyleInput wanted{.track = asked.track, .fallback = asked.fallback};
  std::vector<EmotionMixture> emotions;
  TempoModel tempo{.neutral = kNeutral};
  std::vector<std::string> ratios;
  for (const TimedPhoneme& row : input.transcript) {
    emotions.push_back(asked_at(wanted, 0.5 * (row.start_s + row.end_s)));
    learn_tempo_of(table, emotions.back().heaviest.emotion, tempo, ratios);
    for (const EmotionModifier& part : emotions.back().others) {
      learn_tempo_of(table, part.emotion, tempo, ratios);
    }
  }
  if (tempo.emotions.empty()) {
    notes.emplace_back("every phoneme is neutral: its time stays");
    return;
  }
  const std::vector<TimedPhoneme> retimed = retime(input.transcript, emotions, tempo);
  const auto move = [&](double& time_s) { time_s = retimed_at(input.transcript, retimed, time_s); };
  for (NodeConstraint& constraint : input.constraints) {
    if (constraint.time_s) {
      move(*constraint.time_s);
    }
  }
  for (EmotionSpan& span : asked.track.spans) {
    move(span.start_s);
    move(span.end_s);
  }
  notes.push_back(fmt::format("retimed from {:.2f} s to {:.2f} s; phonemes last, of neutral ones: "
                              "{}",
                              input.transcript.back().end_s, retimed.back().end_s,
                              fmt::join(ratios, ", ")));
  input.transcript = retimed;
}

void add_retimed_transcript(SynthOptions& options) {
  if (!options.retime || options.outputs.empty() ||
      std::ranges::any_of(options.outputs, is_transcript)) {
    return;
  }
  std::filesystem::path beside = options.outputs.front();
  beside.replace_extension(".retimed.lab");
  options.outputs.push_back(std::move(beside));
}

std::string xlabel_text(std::span<const PathRow> rows) {
  std::string text = "#\n";
  for (const PathRow& row : rows) {
    text += fmt::format("{:.4f} 100 {}\n", row.phoneme.end_s, row.phoneme.phoneme.name);
  }
  return text;
}

} // namespace phonomime
