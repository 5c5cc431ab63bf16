// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/node_motion.h"

#include "db/types/errors.h"
#include "tools/evaluate/row_frames.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

namespace phonomime {

namespace {

bool follows_on(const MotionTable& table, NodeIndex node, NodeIndex before) {
  return table.nodes[static_cast<std::size_t>(node)].predecessor == before;
}

} // namespace

FrameMatrix to_channels(const PcaModel& pca, const Eigen::Ref<const FrameMatrixD>& coefficients,
                        Eigen::Index frame_count) {
  if (std::abs(coefficients.rows() - frame_count) > 1 || coefficients.rows() == 0) {
    throw InternalError({.what = "a synthesis and its recording differ in length",
                         .expected = fmt::format("{} frames", frame_count),
                         .got = fmt::format("{}", coefficients.rows())});
  }
  const Eigen::Index both = std::min(frame_count, coefficients.rows());
  FrameMatrix channels(frame_count, pca.channel_count());
  channels.topRows(both) =
      ((coefficients.topRows(both) * pca.basis.transpose()).rowwise() + pca.mean.transpose())
          .cast<float>();
  for (Eigen::Index frame = both; frame < frame_count; ++frame) {
    channels.row(frame) = channels.row(both - 1);
  }
  return channels;
}

std::vector<JoinPlace> join_places(const MotionTable& table, std::span<const TimedPhoneme> rows,
                                   std::span<const NodeIndex> nodes) {
  const std::vector<FrameRange> frames = row_frames(rows, table.rate_hz);
  std::vector<JoinPlace> joins;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (!rows[i].is_silence() && !rows[i - 1].is_silence()) {
      joins.push_back(
          {.frame = frames[i].first, .captured = follows_on(table, nodes[i], nodes[i - 1])});
    }
  }
  return joins;
}

SynthesisedSentence say_nodes(const MotionTable& table, const SentenceRequest& request,
                              std::span<const NodeIndex> nodes, const ConcatOptions& options) {
  std::vector<ConcatStep> steps;
  for (std::size_t i = 0; i < request.rows.size(); ++i) {
    const TimedPhoneme& row = request.rows[i];
    const bool joins = i > 0 && !row.is_silence() && !request.rows[i - 1].is_silence();
    steps.push_back({.is_silence = row.is_silence(),
                     .start_s = row.start_s,
                     .end_s = row.end_s,
                     .node = nodes[i],
                     .captured = joins && follows_on(table, nodes[i], nodes[i - 1])});
  }
  const CoefficientMotion motion = concatenate(table, steps, options);
  return {.method = {},
          .channels = to_channels(table.pca, motion.coefficients, request.frame_count),
          .joins = join_places(table, request.rows, nodes)};
}

} // namespace phonomime
