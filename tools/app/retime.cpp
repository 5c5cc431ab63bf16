// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retime.h"

#include "synth/style/tempo.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

bool is_transcript(const std::filesystem::path& path) {
  return path.extension() == ".lab";
}

} // namespace

void retime_input(const MotionTable& table, SynthesisInput& input,
                  std::vector<std::string>& notes) {
  TrainingOptions options{.styles = {kNeutral}};
  for (const EmotionModifier& emotion : input.emotions) {
    if (std::ranges::find(options.styles, emotion.emotion) == options.styles.end()) {
      options.styles.push_back(emotion.emotion);
    }
  }
  if (options.styles.size() == 1) {
    notes.emplace_back("every phoneme is neutral: its time stays");
    return;
  }
  const TempoModel tempo = learn_tempo(table, options);
  const std::vector<TimedPhoneme> retimed = retime(input.transcript, input.emotions, tempo);
  for (NodeConstraint& constraint : input.constraints) {
    if (constraint.time_s) {
      constraint.time_s = retimed_at(input.transcript, retimed, *constraint.time_s);
    }
  }
  std::vector<std::string> ratios;
  for (const auto& [name, learned] : tempo.emotions) {
    ratios.push_back(fmt::format("{} {:.2f}", name, learned.overall));
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
