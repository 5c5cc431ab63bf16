// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/corpus.h"
#include "db/import/head.h"
#include "db/import/recording.h"
#include "db/types/progress.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// How an import treats a corpus; the rest is in ImportOptions (tools/app).
struct RecordingOptions {
  double tolerance_s = 0.1; // an alignment may be longer or shorter than its motion by this much
  double gap_limit_s = 0.1; // longest gap that is filled
  bool skip_faulty = false; // leave out (and report) a sentence whose files are faulty, instead of
                            // stopping there
  int threads = 0;          // 0: as many as there are
  std::optional<Scale> scale; // of markers, whatever the layout says
};

// A sentence that was left out.
struct Rejection {
  std::size_t sentence = 0; // into Corpus::sentences
  std::string reason;       // the error's message
  bool operator==(const Rejection&) const = default;
};

// A speaker's reference pose and where it is from.
struct ReferencePose {
  Eigen::VectorXd pose; // #channels: mm, centred on the anchor; zeros for weights
  std::string origin;   // "zero", "database", "named frame", "median of neutral silence",
                        // "median of silence"
  std::optional<std::size_t> sentence; // into Corpus::sentences, where it is a frame of one
  double time_s = 0.0;                 // on that sentence's clock
};

// A first look at every recording: what the second, which prepares them, must know of all.
struct Survey {
  std::vector<Recording> recordings; // without the rejected sentences
  std::vector<Rejection> rejections; // in order of sentence
  double fastest_rate_hz = 0.0;
  Scale scale = Scale::measured;
  std::string scale_origin;    // "asked for", "layout", "database", "found"; empty for weights
  double size_variation = 0.0; // of the rigid groups, relative standard deviation over frames
  std::map<std::string, std::int64_t> extra_groups; // not in the layout -> number of files
  std::int64_t files = 0;                           // motion files read
  std::int64_t file_frames = 0;                     // in them
  std::int64_t frames_outside = 0; // in them, in no sentence (rejected ones count as outside)
  std::int64_t frames_shared = 0;  // sentence frames that another sentence has too
  std::map<std::string, ReferencePose> references; // by speaker; markers only
};

// What a database that is added to has settled.
struct KnownHeads {
  std::map<std::string, Eigen::VectorXd> references; // by speaker
  std::optional<Scale> scale;                        // of a database of markers
};

// Reads every motion file and alignment of a corpus once, over `threads` threads, and checks each
// sentence as cut_sentence does. `known` are the poses and the scale that an existing database has:
// those speakers keep theirs. Throws the first fault in order (InputError, IoError) unless they are
// to be skipped, InputError where no sentence is left or a speaker has no frame for a reference
// pose, and Interrupted.
Survey survey_corpus(const Corpus& corpus, const RecordingOptions& options, const KnownHeads& known,
                     const Progress& progress);

} // namespace phonomime
