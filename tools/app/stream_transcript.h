// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/alignment.h"
#include "db/types/emotion_track.h"
#include "db/types/phoneme_set.h"
#include "tools/app/synth_inputs.h"

#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// A row of a transcript with the emotion that it is to show.
struct StreamRow {
  TimedPhoneme phoneme;
  EmotionModifier emotion;
  std::string where; // the line, for messages
};

// A transcript that comes line by line (corpora_schema/transcript.md, "A transcript as a stream"):
// `start end label [emotion]`, times in seconds.
class StreamTranscript {
public:
  // `sets`: the alphabets it may be in, at least one: what has been read is in all that are left.
  // `where` names the stream in errors.
  StreamTranscript(std::vector<PhonemeSet> sets, AskedEmotions emotions, std::string_view where);

  // The rows that the next line gives: none for a comment, an empty line and a silence of no
  // duration, two where it comes after a hole, which is /pau/. Throws InputError with the line's
  // number.
  std::vector<StreamRow> read(std::string_view line);

private:
  void narrow_sets(const AlignedLabel& row);

  std::vector<PhonemeSet> sets_;
  AskedEmotions emotions_;
  Alignment last_;     // the last line that gave a row, and the last line with one
  double end_s_ = 0.0; // of the rows so far
  long line_ = 0;
};

} // namespace phonomime
