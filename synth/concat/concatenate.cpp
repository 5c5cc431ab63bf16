// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/concatenate.h"

#include "db/types/errors.h"
#include "db/types/frame_times.h"
#include "synth/concat/concat_checks.h"
#include "synth/concat/shown_node.h"
#include "synth/concat/time_warp.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace phonomime {
namespace {

void check(const MotionTable& table, std::span<const ConcatStep> steps,
           const ConcatOptions& options) {
  if (steps.empty()) {
    throw InternalError({.what = "there are no steps to concatenate"});
  }
  check_concat_options(table, options);
  double previous_end_s = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    check_concat_step(table, steps[i], i, previous_end_s);
    previous_end_s = steps[i].end_s;
  }
}

// The steps that have a node to show and frames to show it in.
std::vector<ShownNode> share_out_frames(std::span<const ConcatStep> steps, double rate_hz) {
  std::vector<TimeSpan> spans;
  for (const ConcatStep& step : steps) {
    spans.push_back({step.start_s, step.end_s, step.shows()});
  }
  const std::vector<FrameRange> ranges = assign_frames(spans, rate_hz);
  std::vector<ShownNode> shown;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].shows() && ranges[i].count > 0) {
      shown.push_back({steps[i].node, ranges[i], steps[i].captured});
    }
  }
  return shown;
}

void warp_nodes(FrameMatrixD& frames, const MotionTable& table,
                std::span<const ShownNode> shown_nodes) {
  for (const ShownNode& shown : shown_nodes) {
    time_warp(table.node_frames(shown.node),
              frames.middleRows(shown.frames.first, shown.frames.count));
  }
}

void smooth_joins(FrameMatrixD& frames, const MotionTable& table,
                  std::span<const ShownNode> shown_nodes, std::int64_t half_window) {
  for (std::size_t i = 1; i < shown_nodes.size(); ++i) {
    smooth_join(frames, 0, table, shown_nodes[i - 1], shown_nodes[i], half_window);
  }
}

std::vector<std::uint8_t> mark_shown(Eigen::Index frame_count,
                                     std::span<const ShownNode> shown_nodes) {
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(frame_count), 0);
  for (const ShownNode& shown : shown_nodes) {
    std::fill_n(marks.begin() + shown.frames.first, shown.frames.count, std::uint8_t{1});
  }
  return marks;
}

// A frame at the very end lies outside every half-open step: where a phoneme comes last, its last
// frame is held.
void hold_last_phoneme(FrameMatrixD& frames, std::vector<std::uint8_t>& shown,
                       std::span<const ShownNode> shown_nodes) {
  if (!shown_nodes.empty() && shown_nodes.back().frames.end() == frames.rows() - 1) {
    frames.bottomRows(1) = frames.row(frames.rows() - 2);
    shown.back() = 1;
  }
}

} // namespace

CoefficientMotion concatenate(const MotionTable& table, std::span<const ConcatStep> steps,
                              const ConcatOptions& options) {
  check(table, steps, options);
  const double end_s = steps.back().end_s;
  const std::vector<ShownNode> shown_nodes = share_out_frames(steps, table.rate_hz);

  CoefficientMotion motion;
  motion.rate_hz = table.rate_hz;
  motion.coefficients.setZero(frame_count_to(end_s, table.rate_hz), table.coefficients.cols());
  FrameMatrixD& frames = motion.coefficients;

  warp_nodes(frames, table, shown_nodes);
  smooth_joins(frames, table, shown_nodes, options.smoothing_half_window);
  std::vector<std::uint8_t> shown = mark_shown(frames.rows(), shown_nodes);
  if (steps.back().shows()) {
    hold_last_phoneme(frames, shown, shown_nodes);
  }
  fill_silence(frames, shown, table.pca.project(table.reference_pose).transpose(), table.rate_hz,
               options.silence);
  return motion;
}

} // namespace phonomime
