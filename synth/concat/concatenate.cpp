// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/concatenate.h"

#include "db/types/errors.h"
#include "db/types/frame_times.h"
#include "db/types/time_warp.h"
#include "synth/concat/concat_checks.h"
#include "synth/concat/shown_node.h"

#include <algorithm>
#include <cstdint>
#include <utility>
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

// The frames of each step.
std::vector<FrameRange> share_out(std::span<const ConcatStep> steps, double rate_hz) {
  std::vector<TimeSpan> spans;
  for (const ConcatStep& step : steps) {
    spans.push_back({step.start_s, step.end_s, step.shows()});
  }
  return assign_frames(spans, rate_hz);
}

// The steps that have a node to show and frames to show it in.
std::vector<ShownNode> share_out_frames(std::span<const ConcatStep> steps, double rate_hz) {
  const std::vector<FrameRange> ranges = share_out(steps, rate_hz);
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

void check_same_transcript(const std::vector<ConcatStep>& path,
                           const std::vector<ConcatStep>& first) {
  const auto same = [](const ConcatStep& a, const ConcatStep& b) {
    return a.is_silence == b.is_silence && a.start_s == b.start_s && a.end_s == b.end_s &&
           a.show_node == b.show_node;
  };
  if (!std::equal(path.begin(), path.end(), first.begin(), first.end(), same)) {
    throw InternalError({.what = "paths that are to be blended are not of one transcript"});
  }
}

void check_expected(std::span<const FrameMatrixD> expected, const std::vector<ConcatStep>& steps) {
  bool fits = expected.empty() || expected.size() == steps.size();
  for (std::size_t i = 0; fits && i < expected.size(); ++i) {
    fits = !steps[i].shows() || expected[i].rows() > 0;
  }
  if (!fits) {
    throw InternalError({.what = "what is expected is not of the transcript that is blended"});
  }
}

// What is expected over all frames; without rows where nothing is.
FrameMatrixD expected_track(const std::vector<ConcatStep>& steps,
                            std::span<const FrameMatrixD> expected, double rate_hz,
                            const FrameMatrixD& like) {
  if (expected.empty()) {
    return {};
  }
  FrameMatrixD track = FrameMatrixD::Zero(like.rows(), like.cols());
  const std::vector<FrameRange> ranges = share_out(steps, rate_hz);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].shows() && ranges[i].count > 0) {
      time_warp(expected[i], track.middleRows(ranges[i].first, ranges[i].count));
    }
  }
  return track;
}

// Of each stretch of frames that nodes show, the blend of all motions.
FrameMatrixD blend_stretches(const std::vector<FrameMatrixD>& motions, const FrameMatrixD& track,
                             const std::vector<std::uint8_t>& shown, double rate_hz,
                             const BlendOptions& options) {
  FrameMatrixD blended = motions.front();
  const auto end = static_cast<std::ptrdiff_t>(shown.size());
  for (std::ptrdiff_t begin = 0; begin < end;) {
    const auto next = std::find(shown.begin() + begin, shown.end(), !shown[begin]) - shown.begin();
    if (shown[static_cast<std::size_t>(begin)] != 0) {
      std::vector<FrameMatrixD> stretches;
      for (const FrameMatrixD& motion : motions) {
        stretches.emplace_back(motion.middleRows(begin, next - begin));
      }
      const FrameMatrixD expected =
          track.rows() == 0 ? FrameMatrixD() : FrameMatrixD(track.middleRows(begin, next - begin));
      blended.middleRows(begin, next - begin) =
          blend_motions(stretches, expected, rate_hz, options);
    }
    begin = next;
  }
  return blended;
}

} // namespace

CoefficientMotion concatenate(const MotionTable& table, std::span<const ConcatStep> steps,
                              const ConcatOptions& options) {
  const std::vector<ConcatStep> path(steps.begin(), steps.end());
  return concatenate(table, std::span(&path, 1), {}, options);
}

CoefficientMotion concatenate(const MotionTable& table,
                              std::span<const std::vector<ConcatStep>> paths,
                              std::span<const FrameMatrixD> expected,
                              const ConcatOptions& options) {
  const std::vector<ConcatStep>& steps = paths.front();
  for (const std::vector<ConcatStep>& path : paths) {
    check(table, path, options);
    check_same_transcript(path, steps);
  }
  check_expected(expected, steps);
  const double end_s = steps.back().end_s;
  CoefficientMotion motion;
  motion.rate_hz = table.rate_hz;
  motion.coefficients.setZero(frame_count_to(end_s, table.rate_hz), table.coefficients.cols());

  std::vector<FrameMatrixD> motions;
  std::vector<ShownNode> shown_nodes;
  for (const std::vector<ConcatStep>& path : paths) {
    shown_nodes = share_out_frames(path, table.rate_hz);
    FrameMatrixD& frames = motions.emplace_back(motion.coefficients);
    warp_nodes(frames, table, shown_nodes);
    smooth_joins(frames, table, shown_nodes, options.smoothing_half_window);
  }
  std::vector<std::uint8_t> shown = mark_shown(motion.coefficients.rows(), shown_nodes);
  FrameMatrixD& frames = motion.coefficients;
  frames = motions.size() == 1
               ? std::move(motions.front())
               : blend_stretches(motions, expected_track(steps, expected, table.rate_hz, frames),
                                 shown, table.rate_hz, options.blend);
  if (steps.back().shows()) {
    hold_last_phoneme(frames, shown, shown_nodes);
  }
  fill_silence(frames, shown, table.pca.project(table.reference_pose).transpose(), table.rate_hz,
               options.silence);
  return motion;
}

} // namespace phonomime
