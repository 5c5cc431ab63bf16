// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/row_frames.h"

namespace phonomime {

std::vector<FrameRange> row_frames(std::span<const TimedPhoneme> rows, double rate_hz) {
  std::vector<TimeSpan> spans;
  for (const TimedPhoneme& row : rows) {
    spans.push_back({row.start_s, row.end_s, !row.is_silence()});
  }
  return assign_frames(spans, rate_hz);
}

} // namespace phonomime
