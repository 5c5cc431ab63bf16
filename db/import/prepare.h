// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/corpus.h"
#include "db/import/gaps.h"
#include "db/import/recording.h"
#include "db/import/survey.h"
#include "db/types/imported_sentence.h"
#include "db/types/progress.h"

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace phonomime {

// What became of a sentence's frames and gaps. Times in recorded frames.
struct SentenceAccount {
  std::size_t sentence = 0; // into Corpus::sentences
  SourceClock clock;        // of the recorded frames
  std::int64_t recorded_frames = 0;
  std::int64_t frames = 0; // at the database rate = in_nodes + in_silence
  std::int64_t in_nodes = 0;
  std::int64_t in_silence = 0;
  std::int64_t held_frames = 0; // past the last recorded frame (or before the first)
  std::int64_t gap_frames = 0;  // out of the PCA: in a marked gap, or in a node with one
  std::int64_t nodes = 0;
  std::int64_t nodes_with_gap = 0;
  std::int64_t missing = 0;            // group-frames that the recording lacks
  std::int64_t interpolated_poses = 0; // frames whose head pose is from their neighbours
  std::vector<Gap> gaps;
};

struct PreparedSentence {
  ImportedSentence sentence;
  SentenceAccount account;
};

struct PreparedRecording {
  std::vector<PreparedSentence> sentences;
  std::vector<Rejection> rejections; // where faulty sentences are to be skipped
  std::int64_t rejected_frames = 0;  // recorded frames of those
};

// What is the same for every sentence.
struct PrepareContext {
  const Corpus& corpus;
  const Survey& survey;
  const RecordingOptions& options;
  double rate_hz = 0.0; // of the database
};

// Reads one motion file and prepares each of its sentences: head motion off, gaps filled or marked
// (without head motion, so that a filled marker follows the face), resampled, cut into nodes,
// marked where the recording itself shows a fault (recorded_faults.h). Throws InputError (unless
// faulty sentences are to be skipped) and IoError.
PreparedRecording prepare_recording(const Recording& recording, const PrepareContext& context);

// Each recording of the survey, a few at a time over threads: calls take(a few of them) in order.
// Throws as prepare_recording does, and Interrupted. `stage` is what progress is called.
void prepare_recordings(const PrepareContext& context, const Progress& progress,
                        std::string_view stage,
                        const std::function<void(std::vector<PreparedRecording>& some)>& take);

} // namespace phonomime
