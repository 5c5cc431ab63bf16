// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/concat/concatenate.h"

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace phonomime::test {

// A table of random motion: `sentences` sentences of `nodes_each` nodes with 1 to `longest` frames,
// phonemes of all three visibility classes, 100 Hz, `dimensions` coefficients, an identity basis.
inline MotionTable random_table(std::mt19937& random, int sentences, int nodes_each,
                                int longest = 12, int dimensions = 3) {
  MotionTable table;
  table.rate_hz = 100.0;
  table.phonemes = {{"pau", "pau", Visibility::low},
                    {"p", "p", Visibility::high},
                    {"ae", "ae", Visibility::intermediate},
                    {"k", "k", Visibility::low}};
  std::uniform_int_distribution<int> frames(1, longest);
  std::uniform_int_distribution<int> phoneme(1, 3);
  std::normal_distribution<float> value(0.0F, 5.0F);
  std::int64_t first = 0;
  for (int s = 0; s < sentences; ++s) {
    table.sentences.push_back({"s", "neutral", std::to_string(s), ""});
    for (int i = 0; i < nodes_each; ++i) {
      MotionNode node;
      node.phoneme = phoneme(random);
      node.sentence = s;
      node.order = i + 1;
      node.first_frame = first;
      node.frame_count = frames(random);
      node.predecessor = i == 0 ? kNoNode : table.node_count() - 1;
      node.successor = i + 1 == nodes_each ? kNoNode : table.node_count() + 1;
      first += node.frame_count;
      table.nodes.push_back(node);
    }
  }
  table.coefficients.resize(first, dimensions);
  for (Eigen::Index k = 0; k < table.coefficients.size(); ++k) {
    table.coefficients.data()[k] = value(random);
  }
  table.pca.mean = Eigen::VectorXd::Constant(dimensions, 1.0);
  table.pca.basis = Eigen::MatrixXd::Identity(dimensions, dimensions);
  table.pca.variance = Eigen::VectorXd::Ones(dimensions);
  table.reference_pose = Eigen::VectorXd::LinSpaced(dimensions, 2.0, 3.0);
  return table;
}

// Steps one after the other, each of a number of frames at 100 Hz. A node of kNoNode is /pau/.
inline std::vector<ConcatStep> steps_of(const MotionTable& table,
                                        const std::vector<std::pair<NodeIndex, int>>& parts) {
  std::vector<ConcatStep> steps;
  int frame = 0;
  for (const auto& [node, count] : parts) {
    ConcatStep step;
    step.is_silence = node == kNoNode;
    step.start_s = frame / 100.0;
    frame += count;
    step.end_s = frame / 100.0;
    step.node = node;
    step.captured = node != kNoNode && !steps.empty() && steps.back().node != kNoNode &&
                    table.nodes[static_cast<std::size_t>(node)].predecessor == steps.back().node;
    steps.push_back(step);
  }
  return steps;
}

} // namespace phonomime::test
