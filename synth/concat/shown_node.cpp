// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/shown_node.h"

#include "synth/concat/smoothing_spline.h"

#include <algorithm>
#include <vector>

namespace phonomime {

namespace {

double weight_of(const MotionTable& table, NodeIndex node) {
  const auto phoneme = table.nodes[static_cast<std::size_t>(node)].phoneme;
  return smoothing_weight(table.phonemes[static_cast<std::size_t>(phoneme)].visibility);
}

} // namespace

void smooth_join(FrameMatrixD& frames, std::int64_t first, const MotionTable& table,
                 const ShownNode& left, const ShownNode& right, std::int64_t half_window) {
  if (right.captured || left.frames.end() != right.frames.first) {
    return;
  }
  const std::int64_t before = std::min(half_window, left.frames.count);
  const std::int64_t after = std::min(half_window, right.frames.count);
  std::vector<double> weights(static_cast<std::size_t>(before), weight_of(table, left.node));
  weights.resize(static_cast<std::size_t>(before + after), weight_of(table, right.node));
  fit_smoothing_spline(frames.middleRows(right.frames.first - first - before, before + after),
                       weights);
}

} // namespace phonomime
