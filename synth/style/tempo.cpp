// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/tempo.h"

#include "db/types/errors.h"

#include <algorithm>

namespace phonomime {

namespace {

constexpr double kLeastRatio = 0.1; // of any phoneme, however far an emotion is taken

struct Durations { // frames
  double reference = 0.0, emotion = 0.0;
};

EmotionTempo tempo_of(const MotionTable& table, const AlignedSentences& aligned,
                      std::size_t style) {
  Durations all;
  double phonemes = 0.0;
  std::map<std::string, Durations> by_viseme;
  for (const AlignedSentence& sentence : aligned.sentences) {
    for (const Reading& nodes : sentence.nodes) {
      const auto viseme = static_cast<std::size_t>(nodes.front()->viseme);
      for (Durations* sum : {&all, &by_viseme[table.visemes[viseme]]}) {
        sum->reference += nodes.front()->frame_count;
        sum->emotion += nodes[style]->frame_count;
      }
      phonemes += 1.0;
    }
  }
  EmotionTempo tempo{.overall = all.emotion / all.reference};
  const double prior = kTempoPrior * all.reference / phonemes;
  for (const auto& [viseme, sum] : by_viseme) {
    tempo.of_viseme[viseme] = (sum.emotion + prior * tempo.overall) / (sum.reference + prior);
  }
  return tempo;
}

double ratio_of(const TimedPhoneme& row, const EmotionModifier& emotion, const TempoModel& tempo) {
  if (emotion.emotion == tempo.neutral) {
    return 1.0;
  }
  const auto found = tempo.emotions.find(emotion.emotion);
  if (found == tempo.emotions.end()) {
    std::string known = tempo.neutral;
    for (const auto& [name, learned] : tempo.emotions) {
      known += ", " + name;
    }
    throw InputError({.where = "tempo",
                      .what = "the tempo of the emotion " + emotion.emotion + " was not learned",
                      .expected = known,
                      .got = emotion.emotion});
  }
  const auto of_viseme = found->second.of_viseme.find(row.phoneme.viseme);
  const double ratio =
      of_viseme != found->second.of_viseme.end() ? of_viseme->second : found->second.overall;
  return std::max(kLeastRatio, 1.0 + emotion.intensity * (ratio - 1.0));
}

} // namespace

TempoModel learn_tempo(const MotionTable& table, const TrainingOptions& options) {
  const AlignedSentences aligned = align_sentences(table, options);
  TempoModel tempo{.neutral = aligned.styles.front()};
  for (std::size_t style = 1; style < aligned.styles.size(); ++style) {
    tempo.emotions[aligned.styles[style]] = tempo_of(table, aligned, style);
  }
  return tempo;
}

std::vector<TimedPhoneme> retime(std::span<const TimedPhoneme> rows,
                                 std::span<const EmotionModifier> emotions,
                                 const TempoModel& tempo) {
  if (rows.size() != emotions.size()) {
    throw InternalError({.where = "tempo",
                         .what = "there is not one emotion a row",
                         .expected = std::to_string(rows.size()),
                         .got = std::to_string(emotions.size())});
  }
  std::vector<TimedPhoneme> retimed;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    TimedPhoneme row = rows[i];
    const double ratio = row.is_silence() ? 1.0 : ratio_of(row, emotions[i], tempo);
    const double duration_s = ratio * (row.end_s - row.start_s);
    row.start_s = i == 0 ? row.start_s : retimed.back().end_s + (row.start_s - rows[i - 1].end_s);
    row.end_s = row.start_s + duration_s;
    retimed.push_back(std::move(row));
  }
  return retimed;
}

double retimed_at(std::span<const TimedPhoneme> rows, std::span<const TimedPhoneme> retimed,
                  double time_s) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (time_s < rows[i].start_s) { // before the first row, or between two
      return retimed[i].start_s - (rows[i].start_s - time_s);
    }
    if (time_s < rows[i].end_s) {
      const double share = (time_s - rows[i].start_s) / (rows[i].end_s - rows[i].start_s);
      return retimed[i].start_s + share * (retimed[i].end_s - retimed[i].start_s);
    }
  }
  return retimed.back().end_s + (time_s - rows.back().end_s);
}

} // namespace phonomime
