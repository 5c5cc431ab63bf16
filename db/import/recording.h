// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/channels.h"
#include "db/import/corpus.h"
#include "db/import/resample.h"
#include "db/types/alignment.h"
#include "db/types/phoneme_set.h"

#include <vector>

namespace phonomime {

// The sentences that one motion file holds: it is read once for all of them.
struct Recording {
  std::filesystem::path motion;
  std::string motion_name;            // as the first sentence's line writes it
  std::vector<std::size_t> sentences; // into Corpus::sentences, in order
};

// Every motion file of a corpus once, in the order of the table's first mention.
std::vector<Recording> recordings_of(const Corpus& corpus);

// A sentence cut out of its recording, times on its own clock: from 0 to duration_s.
struct RecordedSentence {
  Eigen::Index first_frame = 0; // of the file
  FrameMatrixD frames;          // #recorded by #channels in the layout; NaN = missing
  SourceClock clock;
  double recorded_s = 0.0;        // of motion
  double duration_s = 0.0;        // of motion and alignment together
  std::vector<TimedPhoneme> rows; // from 0 to duration_s, without holes
};

// Cuts a sentence out. Its frames are those at start <= t < end of the file's clock. Without
// `start` and `end` it is the whole file, and its alignment may be up to `tolerance_s` longer or
// shorter than its motion: what a longer one lacks is held later, what a shorter one leaves out is
// /pau/. With them, rows of the alignment outside are left out; a phoneme that lies across the cut
// by more than `tolerance_s` is an error. Throws InputError: an alignment longer or shorter by more
// than the tolerance (with both durations), an unknown phoneme, no frame in the cut, a group that
// is missing in every frame.
RecordedSentence cut_sentence(const LayoutMotion& motion, const Alignment& alignment,
                              const CorpusSentence& sentence, const Corpus& corpus,
                              double tolerance_s);

} // namespace phonomime
