// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/concat_stream.h"

#include "db/types/errors.h"
#include "db/types/time_warp.h"
#include "synth/concat/append_frames.h"
#include "synth/concat/concat_checks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace phonomime {

namespace {

// Frames beside a silence that a border's velocity is taken from.
constexpr Eigen::Index kBorderFrames = 2;

// The options and the table, once they are known to be sound.
const ConcatOptions& checked(const MotionTable& table, const ConcatOptions& options) {
  check_concat_options(table, options);
  return options;
}

} // namespace

ConcatStream::ConcatStream(const MotionTable& table, double fps, const ConcatOptions& options)
    : table_(table), options_(checked(table, options)),
      rest_(table.pca.project(table.reference_pose).transpose()), shares_(table.rate_hz),
      border_(0, table.coefficients.cols()), speech_(0, table.coefficients.cols()),
      output_(table.rate_hz, fps, table.coefficients.cols()) {}

void ConcatStream::announce(const TimeSpan& row) {
  if (row.start_s != announced_end_s_) {
    throw InternalError({.where = "row " + std::to_string(announced_),
                         .what = "does not start exactly where the one before ends"});
  }
  shares_.push(row);
  announced_end_s_ = row.end_s;
  ++announced_;
}

FrameMatrixD ConcatStream::push(const ConcatStep& step) {
  check_concat_step(table_, step, pushed_, pushed_end_s_);
  if (pushed_ == announced_) {
    announce({step.start_s, step.end_s, step.shows()});
  }
  steps_.push_back(step);
  pushed_end_s_ = step.end_s;
  last_shows_ = step.shows();
  ++pushed_;
  take_shared_steps();
  return output_.take();
}

FrameMatrixD ConcatStream::finish() {
  if (pushed_ == 0 || pushed_ != announced_) {
    throw InternalError({.what = "a stream of steps ends without a step for each of its rows"});
  }
  shares_.finish();
  take_shared_steps();
  // A frame at the very end lies outside every half-open step: where a phoneme comes last, its last
  // frame is held.
  const bool has_frame_at_end =
      frame_count_to(pushed_end_s_, table_.rate_hz) > first_frame_at(pushed_end_s_, table_.rate_hz);
  const bool speaks_to_end =
      last_shows_ && (speech_.rows() > 0 || (silent_count_ == 0 && border_.rows() > 0));
  if (has_frame_at_end && !speaks_to_end) {
    keep_silent(1);
  }
  release(speech_.rows(), true);
  if (has_frame_at_end && speaks_to_end) {
    output_.push(border_.bottomRows(1));
  }
  output_.finish(pushed_end_s_);
  return output_.take();
}

void ConcatStream::take_shared_steps() {
  while (!steps_.empty()) {
    const std::optional<FrameRange> frames = shares_.take();
    if (!frames) {
      return;
    }
    if (steps_.front().shows() && frames->count > 0) {
      show(steps_.front(), *frames);
    } else {
      keep_silent(frames->count);
    }
    steps_.pop_front();
  }
}

void ConcatStream::show(const ConcatStep& step, FrameRange frames) {
  const ShownNode shown{step.node, frames, step.captured};
  if (speech_.rows() == 0) {
    speech_first_ = frames.first;
  }
  speech_.conservativeResize(speech_.rows() + frames.count, Eigen::NoChange);
  time_warp(table_.node_frames(step.node), speech_.bottomRows(frames.count));
  if (last_node_) {
    smooth_join(speech_, speech_first_, table_, *last_node_, shown, options_.smoothing_half_window);
  }
  last_node_ = shown;
  const std::int64_t open = std::min<std::int64_t>(options_.smoothing_half_window, frames.count);
  release(speech_.rows() - open, false);
}

void ConcatStream::keep_silent(std::int64_t count) {
  if (count == 0) {
    return;
  }
  if (speech_.rows() > 0) {
    release(speech_.rows(), true);
  }
  silent_count_ += count;
  // At the start the face rests until shortly before it speaks.
  const double kept = std::ceil(options_.silence.rest_within_s * table_.rate_hz) + 1.0;
  if (!last_node_ && options_.silence.rest_at_ends && static_cast<double>(silent_count_) > kept) {
    const auto resting = silent_count_ - static_cast<std::int64_t>(kept);
    output_.push(rest_.replicate(resting, 1));
    silent_count_ -= resting;
  }
}

// The first `count` frames of speech are final; `complete`: silence or nothing follows them.
void ConcatStream::release(Eigen::Index count, bool complete) {
  if (silent_count_ > 0) {
    const bool needs_velocity = options_.silence.fill == SilenceFill::cubic;
    if (!complete && count < (needs_velocity ? kBorderFrames : 1)) {
      return;
    }
    fill_silence_before(count);
  }
  output_.push(speech_.topRows(count));
  const Eigen::Index bordering = std::min(count, kBorderFrames);
  append_frames(border_, speech_.middleRows(count - bordering, bordering));
  drop_frames(border_, border_.rows() - kBorderFrames);
  drop_frames(speech_, count);
  speech_first_ += count;
}

// The silence between `border_` and the first `count` frames of speech.
void ConcatStream::fill_silence_before(Eigen::Index count) {
  const Eigen::Index left = border_.rows();
  const Eigen::Index right = std::min(count, kBorderFrames);
  FrameMatrixD frames(left + silent_count_ + right, speech_.cols());
  frames.topRows(left) = border_;
  frames.bottomRows(right) = speech_.topRows(right);
  std::vector<std::uint8_t> shown(static_cast<std::size_t>(frames.rows()), 1);
  std::fill_n(shown.begin() + left, silent_count_, std::uint8_t{0});
  fill_silence(frames, shown, rest_, table_.rate_hz, options_.silence);
  output_.push(frames.middleRows(left, silent_count_));
  silent_count_ = 0;
  border_.resize(0, Eigen::NoChange);
}

} // namespace phonomime
