// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_source.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "synth/retarget/mapping/cross_mapping.h"
#include "synth/retarget/mapping/pair_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

// The row of MotionTable::coefficients that a pair names.
Eigen::Index row_of(const PairTable::Row& row, const MotionTable& table, const std::string& file) {
  const std::string where = fmt::format("{}:{}", file, row.line);
  const MotionNode& node =
      table.nodes[static_cast<std::size_t>(table.find_node(row.frame.node, where))];
  const auto frame = static_cast<std::int64_t>(std::llround(row.frame.time_s * table.rate_hz));
  if (frame < 0 || frame >= node.frame_count) {
    throw InputError(
        {.where = where,
         .what = "the time is outside the motion node",
         .expected = fmt::format("0 to {:.3f} s", (node.frame_count - 1) / table.rate_hz),
         .got = fmt::format("{} s", row.frame.time_s)});
  }
  return node.first_frame + frame;
}

ReferencePairs read_pairs(const RetargetSource& source) {
  const std::string file = source.options.pairs.string();
  const MotionTable& table = source.table;
  const PairTable read = parse_pair_table(read_file(file), file, source.face.names);
  ReferencePairs pairs{.shapes = read.shapes,
                       .channels = FrameMatrixD(read.weights.rows(), table.pca.channel_count()),
                       .weights = read.weights};
  for (std::size_t i = 0; i < read.rows.size(); ++i) {
    const Eigen::Index row = row_of(read.rows[i], table, file);
    pairs.channels.row(static_cast<Eigen::Index>(i)) =
        table.pca.reconstruct(table.coefficients.row(row).transpose().cast<double>()).transpose();
  }
  return pairs;
}

} // namespace

RetargetedWeights retarget_by_cross_mapping(const RetargetSource& source, const Progress&) {
  if (source.options.pairs.empty()) {
    throw UsageError({.where = "--method cross",
                      .what = "needs frames with their weights",
                      .remedy = "Name the table with --pairs; `phonomime retarget references` "
                                "proposes one."});
  }
  const ReferencePairs pairs = read_pairs(source);
  const CrossMapping mapping(
      source.table.pca, pairs,
      {.dimensions = source.options.dimensions.value_or(kDefaultCrossDimensions)});
  const FrameMatrixD mapped = mapping.weights(source.motion.channels);
  RetargetedWeights result{.weights = FrameMatrixD::Zero(
                               mapped.rows(), static_cast<Eigen::Index>(source.face.names.size())),
                           .notes = {},
                           .figures_json = {}};
  for (std::size_t i = 0; i < mapping.shapes().size(); ++i) {
    const auto at = std::ranges::find(source.face.names, mapping.shapes()[i]);
    result.weights.col(at - source.face.names.begin()) = mapped.col(static_cast<Eigen::Index>(i));
  }
  result.notes.push_back(
      fmt::format("{} pairs, {} dimensions; a pair's weights from the others: {:.3f} off (root "
                  "mean square)",
                  pairs.weights.rows(), mapping.dimensions(), mapping.weight_rms_left_out()));
  result.figures_json = nlohmann::json{{"pairs", pairs.weights.rows()},
                                       {"dimensions", mapping.dimensions()},
                                       {"sigma", mapping.network().sigma()},
                                       {"weight_rms_left_out", mapping.weight_rms_left_out()}}
                            .dump();
  return result;
}

} // namespace phonomime
