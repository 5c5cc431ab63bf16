// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/reference_frames.h"

#include "db/types/errors.h"
#include "db/types/percentile.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace phonomime {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

FrameMatrixD leading(const MotionTable& table, int dimensions) {
  return table.coefficients.leftCols(std::min<Eigen::Index>(dimensions, table.coefficients.cols()))
      .cast<double>();
}

using Class = std::pair<std::int32_t, std::int32_t>; // emotion, viseme

Class class_of(const MotionNode& node) {
  return {node.emotion, node.viseme};
}

Eigen::Index row_of(const MotionTable& table, const ProposedFrame& reference) {
  return table.nodes[static_cast<std::size_t>(reference.node)].first_frame + reference.frame;
}

// Each node's rows of `coefficients`, and the node of each.
struct NodeRows {
  std::vector<Eigen::Index> rows;
  std::vector<NodeIndex> nodes;
};

NodeRows rows_of(const MotionTable& table, std::int32_t emotion) {
  NodeRows found;
  for (NodeIndex n = 0; n < table.node_count(); ++n) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(n)];
    for (std::int32_t frame = 0; frame < node.frame_count; ++frame) {
      if (emotion < 0 || node.emotion == emotion) {
        found.rows.push_back(node.first_frame + frame);
        found.nodes.push_back(n);
      }
    }
  }
  return found;
}

// Lowers `distance_sq` (#among) to that from another row.
void lower(const FrameMatrixD& points, std::span<const Eigen::Index> among, Eigen::Index row,
           std::vector<double>& distance_sq) {
  for (std::size_t i = 0; i < among.size(); ++i) {
    distance_sq[i] =
        std::min(distance_sq[i], (points.row(among[i]) - points.row(row)).squaredNorm());
  }
}

// Of nodes: the one whose middle frame is nearest to the median of their middle frames.
NodeIndex typical(const MotionTable& table, const FrameMatrixD& points,
                  const std::vector<NodeIndex>& nodes) {
  FrameMatrixD middles(static_cast<Eigen::Index>(nodes.size()), points.cols());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(nodes[i])];
    middles.row(static_cast<Eigen::Index>(i)) = points.row(node.first_frame + node.frame_count / 2);
  }
  Eigen::RowVectorXd median(points.cols());
  for (Eigen::Index d = 0; d < points.cols(); ++d) {
    median(d) = *percentile({middles.col(d).begin(), middles.col(d).end()}, 0.5);
  }
  Eigen::Index nearest = 0;
  (middles.rowwise() - median).rowwise().squaredNorm().minCoeff(&nearest);
  return nodes[static_cast<std::size_t>(nearest)];
}

} // namespace

void ReferenceOptions::validate() const {
  if (dimensions < 1 || extremes < 0) {
    throw UsageError({.what = "reference frames cannot be proposed that way",
                      .expected = "at least 1 dimension and 0 extremes",
                      .got = std::to_string(dimensions) + " and " + std::to_string(extremes)});
  }
}

std::vector<Eigen::Index> farthest_points(const FrameMatrixD& points,
                                          std::span<const Eigen::Index> chosen,
                                          std::span<const Eigen::Index> among, int count) {
  std::vector<double> distance_sq(among.size(), kFar);
  for (const Eigen::Index row : chosen) {
    lower(points, among, row, distance_sq);
  }
  std::vector<Eigen::Index> found;
  while (std::ssize(found) < count && !among.empty()) {
    const auto farthest = std::ranges::max_element(distance_sq);
    if (!(*farthest > 0.0)) {
      break;
    }
    found.push_back(among[static_cast<std::size_t>(farthest - distance_sq.begin())]);
    lower(points, among, found.back(), distance_sq);
  }
  return found;
}

std::vector<ProposedFrame> propose_references(const MotionTable& table,
                                              const ReferenceOptions& options) {
  options.validate();
  const FrameMatrixD points = leading(table, options.dimensions);
  std::map<Class, std::vector<NodeIndex>> classes;
  for (NodeIndex n = 0; n < table.node_count(); ++n) {
    classes[class_of(table.nodes[static_cast<std::size_t>(n)])].push_back(n);
  }
  std::vector<ProposedFrame> references;
  std::vector<Eigen::Index> chosen;
  for (const auto& [unused, nodes] : classes) {
    const NodeIndex node = typical(table, points, nodes);
    references.push_back(
        {.node = node, .frame = table.nodes[static_cast<std::size_t>(node)].frame_count / 2});
    chosen.push_back(row_of(table, references.back()));
  }
  for (std::int32_t emotion = 0; emotion < std::ssize(table.emotions); ++emotion) {
    const NodeRows rows = rows_of(table, emotion);
    for (const Eigen::Index row : farthest_points(points, chosen, rows.rows, options.extremes)) {
      const auto at = std::ranges::find(rows.rows, row) - rows.rows.begin();
      const NodeIndex node = rows.nodes[static_cast<std::size_t>(at)];
      const auto first = table.nodes[static_cast<std::size_t>(node)].first_frame;
      references.push_back(
          {.node = node, .frame = static_cast<std::int32_t>(row - first), .extreme = true});
      chosen.push_back(row);
    }
  }
  return references;
}

ReferenceCoverage coverage_of(const MotionTable& table, std::span<const ProposedFrame> references,
                              int dimensions) {
  ReferenceCoverage coverage;
  std::map<Class, bool> classes;
  for (const MotionNode& node : table.nodes) {
    classes[class_of(node)] = false;
  }
  const FrameMatrixD points = leading(table, dimensions);
  const NodeRows all = rows_of(table, -1);
  std::vector<double> distance_sq(all.rows.size(), kFar);
  for (const ProposedFrame& reference : references) {
    lower(points, all.rows, row_of(table, reference), distance_sq);
    classes[class_of(table.nodes[static_cast<std::size_t>(reference.node)])] = true;
  }
  coverage.classes = static_cast<int>(classes.size());
  coverage.classes_met =
      static_cast<int>(std::ranges::count(classes, true, &std::pair<const Class, bool>::second));
  if (references.empty() || all.rows.empty()) {
    return coverage;
  }
  const FrameMatrixD used = points(all.rows, Eigen::all);
  const double variance = (used.rowwise() - used.colwise().mean()).squaredNorm();
  const Eigen::Map<const Eigen::ArrayXd> squares(distance_sq.data(), std::ssize(distance_sq));
  coverage.explained = variance > 0.0 ? 1.0 - squares.sum() / variance : 1.0;
  const Eigen::ArrayXd distances = squares.sqrt();
  const std::vector<double> listed(distances.begin(), distances.end());
  coverage.median = *percentile(listed, 0.5);
  coverage.percentile_95 = *percentile(listed, 0.95);
  Eigen::Index farthest = 0;
  coverage.farthest = distances.maxCoeff(&farthest);
  coverage.farthest_node = all.nodes[static_cast<std::size_t>(farthest)];
  return coverage;
}

} // namespace phonomime
