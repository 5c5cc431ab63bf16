// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace phonomime::demo {

// One phoneme of an utterance: start_s <= t < end_s.
struct Segment {
  std::string phoneme;
  double start_s = 0.0;
  double end_s = 0.0;
};

inline constexpr std::string_view kSilence = "pau";

// The segment file that Festival's utt.save.segs has just written: a line "#", then lines
// "end 100 phoneme". Segments without length (Festival ends some sentences with one) are left out.
// Throws InputError for anything else.
std::vector<Segment> parse_festival_segments(std::string_view text, std::string_view where);

} // namespace phonomime::demo
