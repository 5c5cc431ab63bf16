// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/style/aligned_sentences.h"
#include "synth/style/frame_vectors.h"
#include "synth/style/style_stack.h"

#include <cstdint>
#include <string>
#include <vector>

namespace phonomime {

// What a table has of the same speech in several styles.
struct StyleTraining {
  std::vector<std::string> styles;     // the reference first
  std::vector<StyleStack> parts;       // one a part, none without columns
  std::vector<std::string> sentences;  // ids that are in it, in order
  std::int64_t nodes = 0;              // of the reference, aligned with every style
  std::int64_t nodes_left_out = 0;     // of the reference, in those sentences, not aligned
  std::vector<NotAligned> not_aligned; // in order of sentence
};

// The bundles of aligned phonemes, linear inside each: frame i of a reference node of n frames is
// at (i / (n - 1)) (m - 1) of the m frames of another style's node, at the middle where n = 1. A
// column holds the bundle around that place in each style, taken at the style's own tempo, so that
// it looks as it will when a motion is restyled; at the ends of a sentence its first and last
// spoken frame are repeated. Silence is left out: a synthesis fills it from its borders. Throws
// what align_sentences throws.
StyleTraining gather_styles(const MotionTable& table, const FrameVectors& vectors,
                            const TrainingOptions& options);

} // namespace phonomime
