// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/concat_checks.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <cmath>
#include <string>

namespace phonomime {

namespace {

constexpr double kMostFrames = 1e7; // 28 hours at 100 Hz
constexpr double kSameTime_s = 1e-6;

[[noreturn]] void refuse(std::size_t step, const char* what) {
  throw InternalError({.where = "step " + std::to_string(step), .what = what});
}

} // namespace

void check_concat_options(const MotionTable& table, const ConcatOptions& options) {
  if (!(table.rate_hz > 0.0) || !std::isfinite(table.rate_hz) ||
      table.reference_pose.size() != table.pca.channel_count() ||
      table.coefficients.cols() != table.pca.dimension_count()) {
    throw InternalError({.what = "the motion table's rate, PCA and reference pose do not fit"});
  }
  if (options.smoothing_half_window < 0 || !(options.silence.rest_within_s >= 0.0) ||
      !std::isfinite(options.silence.rest_within_s)) {
    throw InternalError({.what = "a concatenation option is negative or not finite"});
  }
}

void check_concat_step(const MotionTable& table, const ConcatStep& step, std::size_t index,
                       double previous_end_s) {
  if (!(std::abs(step.start_s - previous_end_s) <= kSameTime_s)) {
    refuse(index, "a step does not start where the one before ends");
  }
  if (!(step.end_s >= step.start_s) || !std::isfinite(step.end_s)) {
    refuse(index, "a step ends before it starts");
  }
  if (step.shows() && (step.node < 0 || step.node >= table.node_count())) {
    refuse(index, "a step has no node to show");
  }
  if (step.end_s * table.rate_hz > kMostFrames) {
    throw InputError({.what = "the transcript is too long",
                      .expected = "at most " + format_number(kMostFrames / table.rate_hz) + " s",
                      .got = format_number(step.end_s) + " s"});
  }
}

} // namespace phonomime
