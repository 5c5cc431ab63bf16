// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/phrases.h"

#include "db/import/readers.h"
#include "db/types/emotion_track.h"
#include "db/types/phoneme_set.h"
#include "synth/pipeline/transcript_steps.h"

#include <random>

namespace phonomime::bench {

std::vector<Phrase> read_phrases(const MotionTable& table,
                                 const std::vector<std::filesystem::path>& files) {
  const PhonemeSet set = PhonemeSet::built_in("festival_us");
  std::vector<Phrase> phrases;
  for (const std::filesystem::path& file : files) {
    const std::vector<TimedPhoneme> rows = to_phonemes(read_alignment(file), set);
    EmotionModifier emotion;
    emotion.emotion = table.emotions[phrases.size() % table.emotions.size()];
    const std::vector<EmotionModifier> emotions(rows.size(), emotion);
    TranscriptSteps made = make_transcript_steps(table, rows, emotions, {});
    Phrase phrase;
    phrase.name = std::to_string(made.steps.size()) + " ph";
    phrase.duration_s =
        rows[made.first_row + made.steps.size() - 1].end_s - rows[made.first_row].start_s;
    phrase.steps = std::move(made.steps);
    phrases.push_back(std::move(phrase));
  }
  return phrases;
}

std::vector<Phrase> random_phrases(const MotionTable& table, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto below = [&](std::uint64_t limit) { return random() % limit; };
  std::vector<Phrase> phrases;
  for (int i = 0; i < count; ++i) {
    Phrase phrase;
    phrase.name = "random " + std::to_string(i);
    const auto emotion = static_cast<std::int32_t>(below(table.emotions.size()));
    const std::size_t length = 30 + below(31);
    while (phrase.steps.size() < length) {
      auto node = static_cast<NodeIndex>(below(table.nodes.size()));
      for (std::size_t run = 3 + below(6);
           run > 0 && node != kNoNode && phrase.steps.size() < length; --run) {
        const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
        SearchStep step;
        step.phoneme = info.phoneme;
        step.viseme = info.viseme;
        step.emotion = emotion;
        phrase.steps.push_back(step);
        phrase.duration_s += static_cast<double>(info.frame_count) / table.rate_hz;
        node = info.successor;
      }
    }
    phrases.push_back(std::move(phrase));
  }
  return phrases;
}

} // namespace phonomime::bench
