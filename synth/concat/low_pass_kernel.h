// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace phonomime {

// The interpolation kernel of a change of rate: an ideal low-pass at half of the lower rate under a
// Kaiser window (beta 5, 6 zero crossings a side). Symmetric, so that nothing moves in time.
// Not normalised: whoever sums it divides by the sum of its weights, which makes constants exact.
class LowPassKernel {
public:
  LowPassKernel(double input_rate_hz, double output_rate_hz);

  // Distance from which on the kernel is 0, in input frames.
  double half_width() const { return half_width_; }

  // Weight of an input frame at a distance (in input frames) from the output's time; 1 at 0.
  double operator()(double distance) const;

private:
  double bandwidth_;  // twice the cutoff, in cycles an input frame: min(1, output / input)
  double half_width_; // in input frames
  double window_at_0_;
};

} // namespace phonomime
