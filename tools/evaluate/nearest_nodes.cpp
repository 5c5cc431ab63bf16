// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/nearest_nodes.h"

#include "db/types/errors.h"
#include "db/types/time_warp.h"

#include <limits>
#include <utility>

namespace phonomime {

namespace {

// Covers the rounding of the expanded squares in find(), as a share of the stretch's own sum.
constexpr double kRoundingShare = 1e-9;

// The warp from n to m frames as a matrix, m by n.
FrameMatrixD warp_matrix(Eigen::Index from, Eigen::Index to) {
  FrameMatrixD weights(to, from);
  time_warp(FrameMatrix::Identity(from, from), weights);
  return weights;
}

} // namespace

NearestNodes::NearestNodes(const MotionTable& table) : table_(table) {
  if (table.nodes.empty()) {
    throw InputError({.what = "the database has no motion nodes"});
  }
  std::map<Eigen::Index, std::vector<NodeIndex>> by_length;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    by_length[table.nodes[static_cast<std::size_t>(node)].frame_count].push_back(node);
  }
  for (auto& [frame_count, nodes] : by_length) {
    Group group{.frame_count = frame_count, .nodes = std::move(nodes), .frames = {}};
    group.frames.resize(static_cast<Eigen::Index>(group.nodes.size()),
                        frame_count * table.coefficients.cols());
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      const FrameMatrixD frames = table.node_frames(group.nodes[i]).cast<double>();
      group.frames.row(static_cast<Eigen::Index>(i)) =
          Eigen::Map<const Eigen::RowVectorXd>(frames.data(), frames.size());
    }
    groups_.push_back(std::move(group));
  }
}

const Eigen::VectorXd& NearestNodes::warped_squares(const Group& group,
                                                    Eigen::Index frame_count) const {
  const std::scoped_lock lock(mutex_);
  Eigen::VectorXd& squares = squares_[{group.frame_count, frame_count}];
  if (squares.size() == 0) {
    const FrameMatrixD warp = warp_matrix(group.frame_count, frame_count);
    squares.resize(group.frames.rows());
    for (Eigen::Index i = 0; i < group.frames.rows(); ++i) {
      const Eigen::Map<const FrameMatrixD> frames(group.frames.row(i).data(), group.frame_count,
                                                  table_.coefficients.cols());
      squares(i) = (warp * frames).squaredNorm();
    }
  }
  return squares;
}

double NearestNodes::distance_sq(NodeIndex node, const FrameMatrixD& stretch) const {
  FrameMatrixD warped(stretch.rows(), stretch.cols());
  time_warp(table_.node_frames(node), warped);
  return (warped - stretch).squaredNorm();
}

std::vector<NodeIndex> NearestNodes::find(std::span<const FrameMatrixD> stretches) const {
  const auto count = static_cast<Eigen::Index>(stretches.size());
  const Eigen::Index dimensions = table_.coefficients.cols();
  // |W n - x|^2 = |W n|^2 - 2 <n, W^T x> + |x|^2: per group one matrix product for all stretches.
  std::vector<Eigen::MatrixXd> scores; // per group, #nodes by #stretches, without |x|^2
  Eigen::VectorXd least = Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  for (const Group& group : groups_) {
    Eigen::MatrixXd pulled_back(group.frame_count * dimensions, count);
    for (Eigen::Index s = 0; s < count; ++s) {
      const FrameMatrixD& stretch = stretches[static_cast<std::size_t>(s)];
      const FrameMatrixD back =
          warp_matrix(group.frame_count, stretch.rows()).transpose() * stretch;
      pulled_back.col(s) = Eigen::Map<const Eigen::VectorXd>(back.data(), back.size());
    }
    scores.push_back(-2.0 * (group.frames * pulled_back));
    for (Eigen::Index s = 0; s < count; ++s) {
      scores.back().col(s) += warped_squares(group, stretches[static_cast<std::size_t>(s)].rows());
      least(s) = std::min(least(s), scores.back().col(s).minCoeff());
    }
  }
  // What rounding leaves open is decided by the plain sums.
  std::vector<NodeIndex> nearest;
  for (Eigen::Index s = 0; s < count; ++s) {
    const FrameMatrixD& stretch = stretches[static_cast<std::size_t>(s)];
    const double margin = kRoundingShare * (1.0 + stretch.squaredNorm());
    std::pair<double, NodeIndex> best = {std::numeric_limits<double>::infinity(), kNoNode};
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (Eigen::Index i = 0; i < scores[g].rows(); ++i) {
        if (scores[g](i, s) <= least(s) + margin) {
          const NodeIndex node = groups_[g].nodes[static_cast<std::size_t>(i)];
          best = std::min(best, {distance_sq(node, stretch), node});
        }
      }
    }
    nearest.push_back(best.second);
  }
  return nearest;
}

} // namespace phonomime
