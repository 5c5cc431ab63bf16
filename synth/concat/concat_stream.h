// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/concat/concatenate.h"
#include "synth/concat/shown_node.h"
#include "synth/concat/stream_resample.h"
#include "synth/concat/stream_shares.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace phonomime {

// concatenate() and resample_motion() for a path that is still growing: gives out each output frame
// as soon as no later step can change it. All frames together are those of the two on the whole
// path, to the bit, however the path comes in (but for runs of more phonemes shorter than a frame
// than StreamShares reaches over). Work and memory for a step do not grow with what came before.
//
// What a stage needs of the steps to come: the shares of frames one more row's times (more where
// phonemes are shorter than a frame), which may be told before its node is known; the warp nothing;
// a join its right node; silence the first frame of the next node after its smoothing, at the start
// only for what lies within rest_within_s of it; the change of rate the kernel's half width (0.2 s
// at 30 frames a second).
class ConcatStream {
public:
  // `table` must outlive the stream. Throws InternalError where table, fps or options break what
  // concatenate() and resample_motion() ask.
  ConcatStream(const MotionTable& table, double fps, const ConcatOptions& options = {});

  // Tells the times of the next row before its step comes: `needs_frame` is whether the step will
  // show a node.
  void announce(const TimeSpan& row);

  // The next step of the path, in order, each starting exactly where the one before ends; announced
  // or not. Returns the frames that are final with it: any number by #dimensions, in PCA
  // coefficients at k / fps. Throws as concatenate() does.
  FrameMatrixD push(const ConcatStep& step);

  // No further step comes: the rest of the frames. At least one step has come.
  FrameMatrixD finish();

private:
  void take_shared_steps();
  void show(const ConcatStep& step, FrameRange frames);
  void keep_silent(std::int64_t count);
  void release(Eigen::Index count, bool complete);
  void fill_silence_before(Eigen::Index count);

  const MotionTable& table_;
  ConcatOptions options_;
  Eigen::RowVectorXd rest_; // the reference pose

  StreamShares shares_;
  std::deque<ConcatStep> steps_; // whose frames are not final yet
  std::size_t announced_ = 0;    // rows
  std::size_t pushed_ = 0;       // steps
  double announced_end_s_ = 0.0;
  double pushed_end_s_ = 0.0;
  bool last_shows_ = false; // the last step pushed

  std::optional<ShownNode> last_node_;
  FrameMatrixD border_;           // up to two frames before the silence or `speech_`, final
  std::int64_t silent_count_ = 0; // frames of silence between the two that are still to be filled
  FrameMatrixD speech_;           // shown frames that a join may still change
  std::int64_t speech_first_ = 0; // index of their first
  StreamResampler output_;
};

} // namespace phonomime
