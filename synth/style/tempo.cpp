// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/tempo.h"

#include "db/types/errors.h"

#include <algorithm>

namespace phonomime {

namespace {

constexpr double kLeastRatio = 0.1; // of any phoneme, however far an emotion is taken

struct Durations { // frames
  double reference = 0.0, emotion = 0.0, count = 0.0;

  void add(double of_reference, double of_emotion) {
    reference += of_reference;
    emotion += of_emotion;
    count += 1.0;
  }
  double mean() const { return count > 0.0 ? reference / count : 0.0; }

  // The ratio, as if kTempoPrior more of the mean duration, of all if that is longer, had that of
  // all. Durations are whole frames: those of short phonemes say least about a ratio.
  double drawn_to(const Durations& all) const {
    const double prior = kTempoPrior * std::max(mean(), all.mean());
    return (emotion + prior * all.emotion / all.reference) / (reference + prior);
  }
};

// Frames of the silence between two nodes; 0 where there is none, or something is said there.
double pause_between(const MotionNode& before, const MotionNode& after) {
  const bool silent = after.order == before.order + 2 && after.previous_phoneme == 0;
  return silent ? static_cast<double>(after.first_frame - before.first_frame - before.frame_count)
                : 0.0;
}

EmotionTempo tempo_of(const MotionTable& table, const AlignedSentences& aligned,
                      std::size_t style) {
  Durations all, pauses;
  std::map<std::string, Durations> by_viseme;
  for (const AlignedSentence& sentence : aligned.sentences) {
    const Reading* last = nullptr;
    for (const Reading& nodes : sentence.nodes) {
      const auto viseme = static_cast<std::size_t>(nodes.front()->viseme);
      for (Durations* sum : {&all, &by_viseme[table.visemes[viseme]]}) {
        sum->add(nodes.front()->frame_count, nodes[style]->frame_count);
      }
      if (last != nullptr) {
        const double reference = pause_between(*last->front(), *nodes.front());
        const double emotion = pause_between(*(*last)[style], *nodes[style]);
        if (reference > 0.0 && emotion > 0.0) {
          pauses.add(reference, emotion);
        }
      }
      last = &nodes;
    }
  }
  EmotionTempo tempo{.overall = all.emotion / all.reference};
  for (const auto& [viseme, sum] : by_viseme) {
    tempo.of_viseme[viseme] = sum.drawn_to(all);
  }
  tempo.pause = pauses.drawn_to(all);
  return tempo;
}

// By how much more of its duration a row lasts with this much of an emotion.
double change_by(const TimedPhoneme& row, const EmotionModifier& emotion, const TempoModel& tempo) {
  if (emotion.emotion == tempo.neutral) {
    return 0.0;
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
  const EmotionTempo& own = found->second;
  double ratio = own.overall;
  if (row.is_silence()) {
    ratio = own.pause;
  } else if (const auto of_viseme = own.of_viseme.find(row.phoneme.viseme);
             of_viseme != own.of_viseme.end()) {
    ratio = of_viseme->second;
  }
  return emotion.intensity * (ratio - 1.0);
}

double ratio_of(const TimedPhoneme& row, const EmotionMixture& mixture, const TempoModel& tempo) {
  double ratio = 1.0 + change_by(row, mixture.heaviest, tempo);
  for (const EmotionModifier& part : mixture.others) {
    ratio += change_by(row, part, tempo);
  }
  return std::max(kLeastRatio, ratio);
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
                                 std::span<const EmotionMixture> emotions,
                                 const TempoModel& tempo) {
  if (rows.size() != emotions.size()) {
    throw InternalError({.where = "tempo",
                         .what = "there is not one emotion a row",
                         .expected = std::to_string(rows.size()),
                         .got = std::to_string(emotions.size())});
  }
  const auto said = [](const TimedPhoneme& row) { return !row.is_silence(); };
  const auto first = std::ranges::find_if(rows, said) - rows.begin();
  const auto end = rows.rend() - std::ranges::find_if(rows.rbegin(), rows.rend(), said);
  std::vector<TimedPhoneme> retimed;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    TimedPhoneme row = rows[i];
    const auto at = static_cast<std::ptrdiff_t>(i);
    const double ratio = at >= first && at < end ? ratio_of(row, emotions[i], tempo) : 1.0;
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
