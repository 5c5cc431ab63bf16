// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/path_steps.h"

namespace phonomime {

bool is_captured(const MotionTable& table, std::span<const TimedPhoneme> transcript,
                 std::span<const NodeIndex> nodes, std::size_t i) {
  return i > 0 && !transcript[i].is_silence() && !transcript[i - 1].is_silence() &&
         table.nodes[static_cast<std::size_t>(nodes[i])].predecessor == nodes[i - 1];
}

std::vector<ConcatStep> path_steps(const MotionTable& table,
                                   std::span<const TimedPhoneme> transcript,
                                   std::span<const NodeIndex> nodes) {
  std::vector<ConcatStep> steps;
  for (std::size_t i = 0; i < transcript.size(); ++i) {
    steps.push_back({.is_silence = transcript[i].is_silence(),
                     .start_s = transcript[i].start_s,
                     .end_s = transcript[i].end_s,
                     .node = nodes[i],
                     .captured = is_captured(table, transcript, nodes, i)});
  }
  return steps;
}

} // namespace phonomime
