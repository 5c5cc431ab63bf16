// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/imported_sentence.h"
#include "db/types/motion_table.h"
#include "tests/synth/search/random_tables.h"
#include "tools/evaluate/method.h"

#include <string>
#include <vector>

namespace phonomime::test {

// A small table with triphone contexts: what random_table leaves out.
inline MotionTable contextual_table(Draw& draw, int sentences = 12, int emotions = 1) {
  TableShape shape;
  shape.sentences = sentences;
  shape.emotions = emotions;
  shape.longest_sentence = 9;
  MotionTable table = random_table(shape, draw);
  table.speaker = "s";
  for (MotionNode& node : table.nodes) {
    const auto phoneme = [&](NodeIndex other) {
      return other == kNoNode ? 0 : table.nodes[static_cast<std::size_t>(other)].phoneme;
    };
    node.previous_phoneme = phoneme(node.predecessor);
    node.next_phoneme = phoneme(node.successor);
  }
  return table;
}

// A transcript of random phonemes of the table between silences, in whole frames of 100 Hz, with a
// recording of random motion.
inline ImportedSentence random_sentence(const MotionTable& table, int phonemes, Draw& draw) {
  ImportedSentence sentence;
  sentence.speaker = "s";
  sentence.emotion = table.emotions.front();
  sentence.id = "held_out";
  int frame = 0;
  const auto add = [&](std::size_t phoneme, int frames) {
    sentence.rows.push_back({.phoneme = table.phonemes[phoneme],
                             .start_s = frame / 100.0,
                             .end_s = (frame + frames) / 100.0});
    frame += frames;
  };
  add(0, 30);
  for (int i = 0; i < phonemes; ++i) {
    if (i > 0 && draw.chance(0.15)) {
      add(0, 1 + draw.below(50));
    }
    add(static_cast<std::size_t>(1 + draw.below(static_cast<int>(table.phonemes.size()) - 1)),
        1 + draw.below(9));
  }
  add(0, 30);
  sentence.channels.resize(frame, table.layout.channel_count());
  for (float& value : sentence.channels.reshaped()) {
    value = static_cast<float>(10.0 * draw.symmetric());
  }
  sentence.frame_has_gap.assign(static_cast<std::size_t>(frame), 0);
  return sentence;
}

inline SentenceRequest request_for(const ImportedSentence& sentence, bool with_recording = false) {
  return {.rows = sentence.rows,
          .emotion = sentence.emotion,
          .frame_count = sentence.channels.rows(),
          .recorded = with_recording ? &sentence.channels : nullptr};
}

} // namespace phonomime::test
