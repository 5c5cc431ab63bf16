// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/low_pass.h"
#include "db/types/motion.h"

#include <cstdint>

namespace phonomime {

// resample_motion for frames that come bit by bit: the same samples to the bit, each as soon as the
// frames within the kernel's half width of it are known. Keeps no more frames than that.
class StreamResampler {
public:
  // `dimensions`: columns of every frame. Throws InternalError where a rate is not positive.
  StreamResampler(double rate_hz, double fps, Eigen::Index dimensions);

  // The next frames: any number by #dimensions.
  void push(const Eigen::Ref<const FrameMatrixD>& frames);

  // No further frame comes, and the last sample is at or before end_s. At least one frame has come.
  void finish(double end_s);

  // The samples that have become final since the last call: any number by #dimensions.
  FrameMatrixD take();

private:
  double position(std::int64_t sample) const;
  void sample_up_to(std::int64_t end);
  void drop_what_is_done();

  double rate_hz_;
  double fps_;
  LowPassKernel kernel_;
  FrameMatrixD frames_;          // those that samples to come may need
  std::int64_t first_frame_ = 0; // index of their first
  std::int64_t next_sample_ = 0; // the first that is not final yet
  FrameMatrixD samples_;         // final, not taken yet
};

} // namespace phonomime
