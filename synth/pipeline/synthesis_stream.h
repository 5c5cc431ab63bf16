// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "db/types/motion_table.h"
#include "db/types/node_constraint.h"
#include "synth/concat/concat_stream.h"
#include "synth/pipeline/transcript_steps.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// Chooses nodes for the steps of a transcript that is still growing (StreamingSearch).
class NodeChooser {
public:
  virtual ~NodeChooser() = default;

  // Adds a step; returns the nodes that are final with it, in order.
  virtual std::vector<NodeIndex> push(const SearchStep& step) = 0;

  // No further step comes: the nodes of the rest.
  virtual std::vector<NodeIndex> finish() = 0;
};

struct StreamInput {
  std::vector<NodeConstraint> constraints;
  ConcatOptions concat;
  double fps = 30.0;       // of the frames
  bool keep_steps = false; // for SynthesisStream::steps
};

// The recipe of synthesize() for a transcript that comes row by row: rows in, frames out as soon as
// they are final. Where the chooser takes the nodes that ViterbiSearch would, the frames are those
// of SynthesisResult::output.
//
// /pau/ goes to the chooser once a phoneme follows it: at the end of the transcript it takes no
// node (DESIGN 4). Its frames do not wait for a node of its own.
class SynthesisStream {
public:
  // `table` and `chooser` must outlive the stream. Throws InputError for a constraint with an
  // unknown, ambiguous or pruned node.
  SynthesisStream(const MotionTable& table, NodeChooser& chooser, StreamInput input);

  // The next row, starting exactly where the one before ends; returns the frames that are final
  // with it, in PCA coefficients at k / fps. Throws InputError as make_transcript_steps does.
  FrameMatrixD push(const TimedPhoneme& phoneme, const EmotionModifier& emotion);

  // No further row comes: the rest of the frames. Throws InputError where there was no row, and for
  // a constraint on a row that did not come.
  FrameMatrixD finish();

  // What is met, but is probably not meant, since this was last asked.
  std::vector<std::string> take_warnings();

  std::size_t phoneme_count() const { return phonemes_; } // without /pau/
  double end_s() const { return end_s_; }                 // of the last row
  std::size_t step_count() const { return step_count_; }  // given to the chooser
  const std::vector<SearchStep>& steps() const { return steps_; }

private:
  // A row whose step of the path is not known yet.
  struct OpenRow {
    ConcatStep step;
    bool waits_for_node = false;
  };

  RowConstraint constraint_on_row(const TimedPhoneme& phoneme);
  void choose(SearchStep step);
  void take_nodes(const std::vector<NodeIndex>& nodes);
  void take_node(NodeIndex node);
  FrameMatrixD concatenate_known();

  const MotionTable& table_;
  NodeChooser& chooser_;
  StreamInput input_;
  ConcatStream motion_;
  UnrecordedPhonemes unrecorded_;
  std::vector<bool> constraint_met_; // per constraint: its row has come
  std::vector<std::string> warnings_;

  std::deque<OpenRow> rows_;          // in order of time
  std::deque<SearchStep> pauses_;     // since the last phoneme, not given to the chooser
  std::deque<bool> chosen_is_pause_;  // of the steps that the chooser has and has no node for yet
  std::optional<NodeIndex> previous_; // node of the row before rows_, where that is a phoneme

  std::size_t row_count_ = 0;
  std::size_t step_count_ = 0;
  std::size_t phonemes_ = 0;
  double end_s_ = 0.0;
  std::vector<SearchStep> steps_;
};

} // namespace phonomime
