// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/imported_sentence.h"
#include "db/types/layout.h"
#include "db/types/motion.h"
#include "tools/evaluate/lip_events.h"
#include "tools/evaluate/measure_sums.h"
#include "tools/evaluate/measure_table.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

// A place where one motion node follows another, with no silence between.
struct JoinPlace {
  std::int64_t frame = 0; // first frame of the later node
  bool captured = false;  // the two were recorded one after the other
};

// A sentence as a method makes it: the synthesis or a baseline.
struct SynthesisedSentence {
  std::string method;           // id: "paper"
  FrameMatrix channels;         // #frames by #channels, frame k at k / rate, as the recording
  std::vector<JoinPlace> joins; // in order of frame; empty where the method joins nothing
};

// What measure_sentence has to know beside the sentence.
struct MeasureSetup {
  Layout layout;
  double rate_hz = 0.0;
  Eigen::VectorXd reference_pose; // #channels; of the database that the sentence is normalised with
};

// All that an evaluation keeps of one sentence by one method.
struct SentenceMeasures {
  std::string key; // "speaker/emotion/id"
  std::string emotion;
  std::int64_t frame_count = 0;        // of the recording, the mask's and others
  std::int64_t first_speech_frame = 0; // the mask before gaps are left out
  std::int64_t end_speech_frame = 0;
  MeasureSums sums;                                // within the speech
  std::map<std::string, MeasureSums> phoneme_sums; // by phoneme, /pau/ left out
  std::vector<LipEvent> lip_events;                // rows of /p b m f v/, in order
  std::vector<float> frame_error; // #frames: mean squared error over groups (E13 of one frame)
};

// Compares a synthesis with its recording. Masks:
// - "within the speech" is from the start of the first row that is not silence to the end of the
//   last such row (inner pauses count), without frames that have a gap in the recording;
// - a row's frames are those of DESIGN section 11, without frames that have a gap.
// Pure and free of state: sentences may be measured in parallel. Throws InternalError where the two
// have not the same number of frames and channels, or the layout and the reference pose do not fit.
SentenceMeasures measure_sentence(const MeasureSetup& setup, const ImportedSentence& recorded,
                                  const FrameMatrix& synthesised, std::span<const JoinPlace> joins);

} // namespace phonomime
