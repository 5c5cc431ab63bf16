// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "db/types/motion_table.h"
#include "db/types/node_constraint.h"
#include "db/types/progress.h"
#include "synth/concat/concatenate.h"
#include "synth/pipeline/asked_style.h"
#include "synth/search/viterbi_search.h"

#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// What is to be said, how, and with which recordings.
struct SynthesisInput {
  std::vector<TimedPhoneme> transcript;  // in order of time, from 0 on, without holes
  std::vector<EmotionModifier> emotions; // one for each row: what the search asks for
  StyleInput style;                      // what becomes of it after the search
  std::vector<NodeConstraint> constraints;
  CostWeights weights;
  int blend = 1; // node-disjoint paths that are blended, at least 1
  SearchOptions search;
  ConcatOptions concat;
  double fps = 30.0; // of SynthesisResult::output
};

// One row of the transcript in the result.
struct PathRow {
  TimedPhoneme phoneme;
  std::string emotion;                 // that the search was asked for
  std::optional<EmotionMixture> asked; // of the style model, where it acts
  NodeIndex node = kNoNode;            // none for /pau/ at either end
  bool captured = false;               // joined as recorded to the row before (DESIGN 11)
  bool constrained = false;            // by a `use`
  StepCost cost;
  std::vector<RunnerUp> runners_up;
};

// A path that is blended with the best one.
struct BlendedPath {
  double weight = 0.0;          // of its motion
  double cost = 0.0;            // E4
  std::vector<NodeIndex> nodes; // one for each row of the transcript, as PathRow::node
};

// What a change of style did.
struct StyleOutcome {
  int contacts = 0;       // phonemes that ask for contact
  int contacts_moved = 0; // of them, those that the new style would have taken from their range
  int contacts_left = 0;  // of those, the ones that stayed outside
  double change = 0.0;    // root mean square over frames and groups: mm a marker, or weight
};

struct SynthesisResult {
  double cost = 0.0;                 // E4
  std::vector<PathRow> rows;         // of the best path
  double weight = 1.0;               // of its motion
  double expected_weight = 0.0;      // of the motion that is expected of the words
  std::vector<BlendedPath> blended;  // the others, as they were found
  std::optional<StyleOutcome> style; // where the style model acts
  CoefficientMotion motion;          // at the database's rate
  CoefficientMotion output;          // at SynthesisInput::fps
  std::vector<std::string> warnings;
  SearchCounts counts;
  double search_seconds = 0.0; // wall clock
  double end_s = 0.0;          // of the transcript
};

// The recipe: transcript -> search -> concatenate -> style -> resample. A path whose joins are all
// captured is a recording, and is not blended. `search` keeps what it knows of the table between
// calls. Throws InputError (see make_transcript_steps) and Interrupted.
SynthesisResult synthesize(const MotionTable& table, ViterbiSearch& search,
                           const SynthesisInput& input, const Progress& progress = {});

} // namespace phonomime
