// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <cstdint>
#include <string>
#include <vector>

namespace phonomime {

// A sentence as the database keeps it, with its channels: what is judged.
struct StoredSentence {
  struct Node {
    std::int32_t row = 0; // `order` of its key
    std::string phoneme;
    double duration_s = 0.0;      // in the alignment
    std::int32_t first_frame = 0; // into the sentence's frames
    std::int32_t frame_count = 0;
    bool has_gap = false;
    bool pruned = false;
  };

  std::int64_t id = 0; // the database's own
  std::string speaker, emotion, name;
  std::vector<Node> nodes;                 // in order of row
  FrameMatrix channels;                    // #frames by #channels, mm or weights
  std::vector<std::uint8_t> frame_has_gap; // #frames; 1 = some channel was missing, and not filled
};

} // namespace phonomime
