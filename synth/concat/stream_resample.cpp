// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/stream_resample.h"

#include "db/types/errors.h"
#include "db/types/frame_times.h"
#include "synth/concat/append_frames.h"
#include "synth/concat/resample.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace phonomime {

StreamResampler::StreamResampler(double rate_hz, double fps, Eigen::Index dimensions)
    : rate_hz_(rate_hz), fps_(fps), kernel_(rate_hz, fps, kOutputLowPass), frames_(0, dimensions),
      samples_(0, dimensions) {
  if (!(rate_hz > 0.0 && fps > 0.0) || !std::isfinite(rate_hz) || !std::isfinite(fps)) {
    throw InternalError({.what = "a rate of a motion to resample is not positive"});
  }
}

void StreamResampler::push(const Eigen::Ref<const FrameMatrixD>& frames) {
  if (frames.rows() == 0) {
    return;
  }
  if (fps_ == rate_hz_) {
    append_frames(samples_, frames);
    return;
  }
  append_frames(frames_, frames);
  const auto known = static_cast<double>(first_frame_ + frames_.rows() - 1);
  std::int64_t end = next_sample_;
  while (std::floor(position(end) + kernel_.half_width()) <= known) {
    ++end;
  }
  sample_up_to(end);
  drop_what_is_done();
}

void StreamResampler::finish(double end_s) {
  if (fps_ != rate_hz_) {
    sample_up_to(frame_count_to(end_s, fps_));
  }
}

FrameMatrixD StreamResampler::take() {
  return std::exchange(samples_, FrameMatrixD(0, samples_.cols()));
}

double StreamResampler::position(std::int64_t sample) const {
  return static_cast<double>(sample) * rate_hz_ / fps_;
}

void StreamResampler::sample_up_to(std::int64_t end) {
  if (end <= next_sample_) {
    return;
  }
  const Eigen::Index last = first_frame_ + frames_.rows() - 1;
  const Eigen::Index before = samples_.rows();
  samples_.conservativeResize(before + (end - next_sample_), Eigen::NoChange);
  for (Eigen::Index row = before; row < samples_.rows(); ++row, ++next_sample_) {
    low_pass_at({frames_, first_frame_, last},
                std::min(position(next_sample_), static_cast<double>(last)), kernel_,
                samples_.row(row));
  }
}

void StreamResampler::drop_what_is_done() {
  // At the end of the motion a sample may be held at the last frame, up to one before its time.
  constexpr double kMargin = 2.0;
  const double oldest = std::floor(position(next_sample_) - kernel_.half_width()) - kMargin;
  const auto done = static_cast<Eigen::Index>(std::clamp(
      oldest - static_cast<double>(first_frame_), 0.0, static_cast<double>(frames_.rows() - 1)));
  drop_frames(frames_, done);
  first_frame_ += done;
}

} // namespace phonomime
