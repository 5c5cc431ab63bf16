// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/synthesis_stream.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/concat/append_frames.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

SynthesisStream::SynthesisStream(const MotionTable& table, NodeChooser& chooser, StreamInput input)
    : table_(table), chooser_(chooser), input_(std::move(input)),
      motion_(table, input_.fps, input_.concat), unrecorded_(table),
      constraint_met_(input_.constraints.size(), false) {
  for (const NodeConstraint& constraint : input_.constraints) {
    for (const std::string& key : constraint.keys) {
      table.find_node(key, constraint.where);
    }
  }
}

FrameMatrixD SynthesisStream::push(const TimedPhoneme& phoneme, const EmotionModifier& emotion) {
  RowConstraint constraint = constraint_on_row(phoneme);
  const bool used = constraint.use.has_value();
  const bool silence = phoneme.is_silence();
  SearchStep step = make_search_step(table_, phoneme.phoneme, emotion, std::move(constraint));
  unrecorded_.warn_of(phoneme.phoneme, step, warnings_);

  motion_.announce({phoneme.start_s, phoneme.end_s, !silence || used});
  rows_.push_back({.step = {.is_silence = silence,
                            .start_s = phoneme.start_s,
                            .end_s = phoneme.end_s,
                            .show_node = silence && used},
                   .waits_for_node = !silence || used});
  ++row_count_;
  phonemes_ += silence ? 0 : 1;
  end_s_ = phoneme.end_s;
  if (!rows_.back().waits_for_node) {
    if (step_count_ > 0) { // /pau/ at the start takes no node
      pauses_.push_back(std::move(step));
    }
  } else {
    for (SearchStep& pause : pauses_) {
      chosen_is_pause_.push_back(true);
      choose(std::move(pause));
    }
    pauses_.clear();
    chosen_is_pause_.push_back(false);
    choose(std::move(step));
  }
  return concatenate_known();
}

FrameMatrixD SynthesisStream::finish() {
  if (row_count_ == 0) {
    throw InputError({.what = "the transcript is empty"});
  }
  for (std::size_t i = 0; i < input_.constraints.size(); ++i) {
    if (!constraint_met_[i]) {
      const NodeConstraint& constraint = input_.constraints[i];
      throw InputError({.where = constraint.where,
                        .what = "the transcript ended before the constraint's row or time",
                        .expected = fmt::format("0 to {} or a time before {} s", row_count_ - 1,
                                                format_number(end_s_)),
                        .got = constraint.index ? fmt::format("{}", *constraint.index)
                                                : format_number(*constraint.time_s) + " s"});
    }
  }
  if (step_count_ > 0) {
    take_nodes(chooser_.finish());
  }
  FrameMatrixD frames = concatenate_known();
  if (!rows_.empty()) {
    throw InternalError({.what = "the search of a stream ended without a node for each step"});
  }
  append_frames(frames, motion_.finish());
  return frames;
}

std::vector<std::string> SynthesisStream::take_warnings() {
  return std::exchange(warnings_, {});
}

RowConstraint SynthesisStream::constraint_on_row(const TimedPhoneme& phoneme) {
  RowConstraint row;
  for (std::size_t i = 0; i < input_.constraints.size(); ++i) {
    const NodeConstraint& constraint = input_.constraints[i];
    const bool here = constraint.index ? *constraint.index == static_cast<long>(row_count_)
                                       : phoneme.start_s <= *constraint.time_s &&
                                             *constraint.time_s < phoneme.end_s;
    if (here) {
      add_constraint(table_, constraint, row_count_, phoneme, row, warnings_);
      constraint_met_[i] = true;
    }
  }
  return row;
}

void SynthesisStream::choose(SearchStep step) {
  ++step_count_;
  const std::vector<NodeIndex> nodes = chooser_.push(step);
  if (input_.keep_steps) {
    steps_.push_back(std::move(step));
  }
  take_nodes(nodes);
}

void SynthesisStream::take_nodes(const std::vector<NodeIndex>& nodes) {
  for (const NodeIndex node : nodes) {
    if (chosen_is_pause_.empty()) {
      throw InternalError({.what = "the search of a stream gave more nodes than it has steps"});
    }
    if (!chosen_is_pause_.front()) {
      take_node(node);
    }
    chosen_is_pause_.pop_front();
  }
}

void SynthesisStream::take_node(NodeIndex node) {
  const auto row = std::ranges::find(rows_, true, &OpenRow::waits_for_node);
  row->step.node = node;
  row->waits_for_node = false;
}

// The frames that the first rows give, up to one that waits for its node.
FrameMatrixD SynthesisStream::concatenate_known() {
  FrameMatrixD frames(0, table_.coefficients.cols());
  while (!rows_.empty() && !rows_.front().waits_for_node) {
    ConcatStep& step = rows_.front().step;
    step.captured = !step.is_silence && previous_ &&
                    table_.nodes[static_cast<std::size_t>(step.node)].predecessor == *previous_;
    append_frames(frames, motion_.push(step));
    previous_ = step.is_silence ? std::nullopt : std::optional(step.node);
    rows_.pop_front();
  }
  return frames;
}

} // namespace phonomime
