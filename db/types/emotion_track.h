// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace phonomime {

// One line of an emotion track, half-open in time.
struct EmotionSpan {
  double start_s = 0.0;
  double end_s = 0.0;
  std::string emotion;
  double intensity = 1.0;  // 0 to 1.5; 1 = as recorded
  long line = 0;
};

// Spans in order of time, none overlapping.
struct EmotionTrack {
  std::string source;  // path, for messages
  std::vector<EmotionSpan> spans;
};

}  // namespace phonomime
