// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "tests/synth/style/made_speech.h"

#include <string>
#include <utility>
#include <vector>

#include <Eigen/QR>

namespace phonomime::test {

inline PcaModel made_pca() {
  MadeNumbers numbers(5);
  PcaModel pca;
  pca.mean = 10.0 * numbers.matrix(6, 1);
  const Eigen::MatrixXd columns = numbers.matrix(6, 2);
  pca.basis = Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() *
              Eigen::MatrixXd::Identity(6, 2);
  return pca;
}

struct Spoken {
  std::string phoneme;
  int frames = 1;
};

// A table in which every node of a phoneme moves on the same line: coefficient 0 is 10 times the
// phoneme's index plus the relative time, coefficient 1 is the emotion's index. "pau" has frames
// and no node.
class MadeTable {
public:
  MadeTable() {
    table.pca = made_pca();
    table.phonemes = {{"pau", "pau"}, {"a", "a"}, {"b", "b"}, {"c", "c"}};
    table.visemes = {"pau", "a", "b", "c"};
    table.emotions = {"anger", "neutral", "joy"};
    table.speaker = "x";
  }

  void say(const std::string& id, const std::string& emotion, const std::vector<Spoken>& spoken) {
    const auto emotion_index = *table.find_emotion(emotion);
    table.sentences.push_back({"x", emotion, id, ""});
    std::int32_t order = 0, previous = 0;
    for (const Spoken& part : spoken) {
      MotionNode node;
      node.phoneme = *table.find_phoneme(part.phoneme);
      node.order = order++;
      node.previous_phoneme = std::exchange(previous, node.phoneme);
      node.viseme = node.phoneme;
      node.emotion = emotion_index;
      node.sentence = static_cast<std::int32_t>(table.sentences.size()) - 1;
      node.first_frame = table.coefficients.rows();
      node.frame_count = part.frames;
      table.coefficients.conservativeResize(node.first_frame + part.frames, 2);
      for (int i = 0; i < part.frames; ++i) {
        const float relative =
            part.frames > 1 ? static_cast<float>(i) / static_cast<float>(part.frames - 1) : 0.5F;
        table.coefficients(node.first_frame + i, 0) =
            10.0F * static_cast<float>(node.phoneme) + relative;
        table.coefficients(node.first_frame + i, 1) = static_cast<float>(emotion_index);
      }
      if (node.phoneme != 0) {
        table.nodes.push_back(node);
      }
    }
  }

  MotionTable table;
};

} // namespace phonomime::test
