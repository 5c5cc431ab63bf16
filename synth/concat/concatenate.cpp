// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/concatenate.h"

#include "db/types/errors.h"
#include "db/types/frame_times.h"
#include "db/types/text.h"
#include "synth/concat/smoothing_spline.h"
#include "synth/concat/time_warp.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace phonomime {
namespace {

constexpr double kMostFrames = 1e7; // 28 hours at 100 Hz
constexpr double kSameTime_s = 1e-6;

// A step whose node is seen, with the frames it has.
struct ShownNode {
  NodeIndex node = kNoNode;
  FrameRange frames;
  bool captured = false; // as recorded after the node before it
};

bool shows_node(const ConcatStep& step) {
  return !step.is_silence || step.show_node;
}

[[noreturn]] void refuse(std::size_t step, const char* what) {
  throw InternalError({.where = "step " + std::to_string(step), .what = what});
}

void check(const MotionTable& table, std::span<const ConcatStep> steps,
           const ConcatOptions& options) {
  if (steps.empty()) {
    throw InternalError({.what = "there are no steps to concatenate"});
  }
  if (!(table.rate_hz > 0.0) || !std::isfinite(table.rate_hz) ||
      table.reference_pose.size() != table.pca.channel_count() ||
      table.coefficients.cols() != table.pca.dimension_count()) {
    throw InternalError({.what = "the motion table's rate, PCA and reference pose do not fit"});
  }
  if (options.smoothing_half_window < 0 || !(options.silence.rest_within_s >= 0.0) ||
      !std::isfinite(options.silence.rest_within_s)) {
    throw InternalError({.what = "a concatenation option is negative or not finite"});
  }
  double previous_end_s = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const ConcatStep& step = steps[i];
    if (!(std::abs(step.start_s - previous_end_s) <= kSameTime_s)) {
      refuse(i, "a step does not start where the one before ends");
    }
    if (!(step.end_s >= step.start_s) || !std::isfinite(step.end_s)) {
      refuse(i, "a step ends before it starts");
    }
    if (shows_node(step) && (step.node < 0 || step.node >= table.node_count())) {
      refuse(i, "a step has no node to show");
    }
    previous_end_s = step.end_s;
  }
  if (previous_end_s * table.rate_hz > kMostFrames) {
    throw InputError({.what = "the transcript is too long",
                      .expected = "at most " + format_number(kMostFrames / table.rate_hz) + " s",
                      .got = format_number(previous_end_s) + " s"});
  }
}

// The steps that have a node to show and frames to show it in.
std::vector<ShownNode> share_out_frames(std::span<const ConcatStep> steps, double rate_hz) {
  std::vector<TimeSpan> spans;
  for (const ConcatStep& step : steps) {
    spans.push_back({step.start_s, step.end_s, shows_node(step)});
  }
  const std::vector<FrameRange> ranges = assign_frames(spans, rate_hz);
  std::vector<ShownNode> shown;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (shows_node(steps[i]) && ranges[i].count > 0) {
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

double weight_of(const MotionTable& table, NodeIndex node) {
  const auto phoneme = table.nodes[static_cast<std::size_t>(node)].phoneme;
  return smoothing_weight(table.phonemes[static_cast<std::size_t>(phoneme)].visibility);
}

void smooth_joins(FrameMatrixD& frames, const MotionTable& table,
                  std::span<const ShownNode> shown_nodes, std::int64_t half_window) {
  std::vector<double> weights;
  for (std::size_t i = 1; i < shown_nodes.size(); ++i) {
    const ShownNode& left = shown_nodes[i - 1];
    const ShownNode& right = shown_nodes[i];
    if (right.captured || left.frames.end() != right.frames.first) {
      continue;
    }
    const std::int64_t before = std::min(half_window, left.frames.count);
    const std::int64_t after = std::min(half_window, right.frames.count);
    weights.assign(static_cast<std::size_t>(before), weight_of(table, left.node));
    weights.resize(static_cast<std::size_t>(before + after), weight_of(table, right.node));
    fit_smoothing_spline(frames.middleRows(right.frames.first - before, before + after), weights);
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
  if (shows_node(steps.back())) {
    hold_last_phoneme(frames, shown, shown_nodes);
  }
  fill_silence(frames, shown, table.pca.project(table.reference_pose).transpose(), table.rate_hz,
               options.silence);
  return motion;
}

} // namespace phonomime
