// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <span>

namespace phonomime {

// A windowed sinc, with all lengths relative to the lower one of two rates.
struct LowPassShape {
  double cutoff = 1.0;            // share of half the lower rate
  double half_width_frames = 6.0; // of the lower rate
  double kaiser_beta = 5.0;
};

// The interpolation kernel of a change of rate: an ideal low-pass under a Kaiser window. Symmetric,
// so that nothing moves in time. Not normalised: whoever sums it divides by the sum of its weights,
// which makes constants exact.
class LowPassKernel {
public:
  LowPassKernel(double input_rate_hz, double output_rate_hz, const LowPassShape& shape);

  // Distance from which on the kernel is 0, in input frames.
  double half_width() const { return half_width_; }

  // Weight of an input frame at a distance (in input frames) from the output's time; 1 at 0.
  double operator()(double distance) const;

private:
  double bandwidth_;  // twice the cutoff, in cycles an input frame
  double half_width_; // in input frames
  double kaiser_beta_;
  double window_at_0_;
};

// `frames` (#frames by #columns, at least one) at the positions (#positions, in frames, from 0 to
// the last): #positions by #columns. Each row is a sum of frames under the kernel; constants come
// out exactly. Beyond its first and last frame the motion is continued by point reflection at that
// frame, which keeps its slope. (libsamplerate is no fit: float samples, zeros beyond the ends, a
// length off by a frame.)
FrameMatrixD low_pass(const FrameMatrixD& frames, std::span<const double> positions,
                      const LowPassKernel& kernel);

// A stretch of a motion: row i is the motion's frame first + i. `last` is the motion's last frame.
struct FrameWindow {
  const FrameMatrixD& frames;
  Eigen::Index first = 0;
  Eigen::Index last = 0;
};

// The row of low_pass at one position, to the bit, from a window that holds every frame within the
// kernel's half width of it, and as far from an end of the motion what is reflected there: 1 by
// #columns.
void low_pass_at(const FrameWindow& window, double position, const LowPassKernel& kernel,
                 Eigen::Ref<Eigen::RowVectorXd> result);

} // namespace phonomime
