// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "db/types/phoneme_set.h"
#include "db/types/suspect_mark.h"

#include <cstdint>
#include <string>
#include <vector>

namespace phonomime {

// A motion node before it has an index.
struct ImportedNode {
  std::int32_t row = 0;         // of ImportedSentence::rows; the `order` of the node's key
  std::int32_t first_frame = 0; // into the sentence's frames
  std::int32_t frame_count = 0;
  bool has_gap = false;             // holds frames whose gaps were too long to fill
  std::vector<SuspectMark> suspect; // what its recording shows; empty = nothing
};

// One sentence as the importer hands it to the store: at the database rate, head motion off.
struct ImportedSentence {
  std::string speaker;
  std::string emotion;
  std::string id;
  std::string text;
  std::string audio;                       // absolute path of the recording's WAV, or empty
  std::vector<TimedPhoneme> rows;          // the alignment, silence too, from 0 to the end
  std::vector<ImportedNode> nodes;         // in order of row
  FrameMatrix channels;                    // #frames by #channels, mm or weights; finite everywhere
  std::vector<std::uint8_t> frame_has_gap; // #frames; 1 = out of the PCA: a channel was missing and
                                           // not filled, here or elsewhere in its node
  std::vector<HeadPose> head;              // #frames for markers, empty for weights
};

} // namespace phonomime
