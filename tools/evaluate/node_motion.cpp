// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/node_motion.h"

#include "db/types/errors.h"
#include "db/types/row_frames.h"
#include "synth/pipeline/path_steps.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

namespace phonomime {

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
      joins.push_back({.frame = frames[i].first, .captured = is_captured(table, rows, nodes, i)});
    }
  }
  return joins;
}

SynthesisedSentence say_nodes(const MotionTable& table, const SentenceRequest& request,
                              std::span<const NodeIndex> nodes, const ConcatOptions& options) {
  const std::vector<ConcatStep> steps = path_steps(table, request.rows, nodes);
  const CoefficientMotion motion = concatenate(table, steps, options);
  return {.method = {},
          .channels = to_channels(table.pca, motion.coefficients, request.frame_count),
          .joins = join_places(table, request.rows, nodes)};
}

} // namespace phonomime
