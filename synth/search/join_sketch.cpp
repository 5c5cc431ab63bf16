// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_sketch.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"
#include "synth/search/group_weights.h"
#include "synth/search/linear_features.h"
#include "synth/search/motion_clusters.h"
#include "synth/search/nodes_by_key.h"

#include <algorithm>
#include <utility>

#include <Eigen/Eigenvalues>

namespace phonomime {

namespace {

constexpr auto kHalf = static_cast<Eigen::Index>(JoinSketch::kFeatures / 2);

// Covariance of the velocities at the starts of nodes (coefficients a frame), over a fixed sample.
Eigen::MatrixXd velocity_covariance(const MotionTable& table) {
  constexpr std::size_t kSample = 4096;
  const std::size_t stride = std::max<std::size_t>(1, table.nodes.size() / kSample);
  const Eigen::Index dimensions = table.pca.dimension_count();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(dimensions, dimensions) * 1e-12;
  for (std::size_t i = 0; i < table.nodes.size(); i += stride) {
    const MotionNode& node = table.nodes[i];
    if (node.frame_count > 1) {
      const Eigen::VectorXd change =
          (table.coefficients.row(node.first_frame + 1) - table.coefficients.row(node.first_frame))
              .cast<double>()
              .transpose();
      covariance += change * change.transpose();
    }
  }
  return covariance;
}

// `axes_each` principal axes of every cluster's motion, weighted as the class comment says.
FrameMatrixD sketch_rows(const std::vector<Eigen::MatrixXd>& clusters,
                         const Eigen::MatrixXd& covariance, Eigen::Index axes_each, double scale) {
  FrameMatrixD rows = FrameMatrixD::Zero(kHalf, covariance.cols());
  Eigen::Index row = 0;
  for (const Eigen::MatrixXd& cluster : clusters) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(cluster * covariance *
                                                              cluster.transpose());
    Eigen::VectorXd weights =
        axes.eigenvalues().reverse().head(axes_each).cwiseMax(0.0).cwiseSqrt();
    if (weights.norm() == 0.0) {
      weights[0] = 1.0; // nothing moves there: any weights will do
    }
    weights.normalize();
    for (Eigen::Index a = 0; a < axes_each; ++a) {
      rows.row(row++) = scale * weights[a] *
                        axes.eigenvectors().col(cluster.rows() - 1 - a).transpose() * cluster;
    }
  }
  return rows;
}

constexpr std::size_t kWidth = JoinSketch::kFeatures;

// Along which feature nodes[0, count) differ most.
PHONOMIME_DISPATCHED
std::size_t widest_feature(const NodeIndex* nodes, std::size_t count, const float* features) {
  constexpr std::size_t kParts = kWidth / kFloatLanes;
  FloatLanes low[kParts], high[kParts];
  for (std::size_t part = 0; part < kParts; ++part) {
    load(low[part], features + static_cast<std::size_t>(nodes[0]) * kWidth + part * kFloatLanes);
    high[part] = low[part];
  }
  for (std::size_t i = 1; i < count; ++i) {
    const float* features_of = features + static_cast<std::size_t>(nodes[i]) * kWidth;
    for (std::size_t part = 0; part < kParts; ++part) {
      FloatLanes own;
      load(own, features_of + part * kFloatLanes);
      low[part] = own < low[part] ? own : low[part];
      high[part] = own > high[part] ? own : high[part];
    }
  }
  const auto width = [&](std::size_t f) {
    return high[f / kFloatLanes][f % kFloatLanes] - low[f / kFloatLanes][f % kFloatLanes];
  };
  std::size_t widest = 0;
  for (std::size_t f = 1; f < kWidth; ++f) {
    if (width(f) > width(widest)) {
      widest = f;
    }
  }
  return widest;
}

// Puts nodes[0, count) in an order where neighbours are alike, by halving along the widest feature.
// `values`: room for as many.
void order_by_halves(NodeIndex* nodes, std::size_t count, const float* features,
                     std::pair<float, NodeIndex>* values) {
  constexpr std::size_t kLeaf = 8;
  if (count <= kLeaf) {
    return;
  }
  const std::size_t widest = widest_feature(nodes, count, features);
  // Left parts hold whole groups of eight, and of eight times eight, where there are so many.
  std::size_t unit = kLeaf;
  while (unit * kLeaf < count) {
    unit *= kLeaf;
  }
  const std::size_t left = std::max(unit, count / 2 / unit * unit);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = {features[static_cast<std::size_t>(nodes[i]) * kWidth + widest], nodes[i]};
  }
  std::nth_element(values, values + left, values + count);
  for (std::size_t i = 0; i < count; ++i) {
    nodes[i] = values[i].second;
  }
  order_by_halves(nodes, left, features, values);
  order_by_halves(nodes + left, count - left, features, values);
}

std::vector<NodeIndex> order_ends(const MotionTable& table, NodeEnd which,
                                  const std::vector<float>& features) {
  const std::size_t visemes = table.visemes.size() + 1;
  const std::size_t emotions = table.emotions.size();
  std::vector<std::size_t> keys;
  keys.reserve(table.nodes.size());
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
    const auto viseme = static_cast<std::size_t>(join_viseme(table, which, node) + 1);
    keys.push_back((viseme + visemes * static_cast<std::size_t>(info.phoneme)) * emotions +
                   static_cast<std::size_t>(info.emotion));
  }
  NodesByKey classes = nodes_by_key(keys);
  std::vector<std::pair<float, NodeIndex>> values(classes.nodes.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < classes.count(); ++i) {
    const std::size_t begin = classes.begins[i];
    order_by_halves(classes.nodes.data() + begin, classes.begins[i + 1] - begin, features.data(),
                    values.data() + begin);
  }
  return std::move(classes.nodes);
}

std::vector<std::int32_t> places(const std::vector<NodeIndex>& order) {
  std::vector<std::int32_t> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
  }
  return rank;
}

} // namespace

std::int32_t join_viseme(const MotionTable& table, NodeEnd which, NodeIndex node) {
  const MotionNode& info = table.nodes[static_cast<std::size_t>(node)];
  if (which == NodeEnd::last) {
    return info.viseme;
  }
  return info.predecessor == kNoNode
             ? -1
             : table.nodes[static_cast<std::size_t>(info.predecessor)].viseme;
}

JoinSketch::JoinSketch(const MotionTable& table, const CostWeights& weights, double largest_frame)
    : first_(table.nodes.size() * kFeatures), last_(table.nodes.size() * kFeatures) {
  const Eigen::Index axes_each = std::min(2, table.layout.channels_per_group());
  const std::vector<Eigen::MatrixXd> clusters = cluster_channel_groups(
      table, weighted_basis(table, weights), static_cast<int>(kHalf / axes_each));
  const Eigen::MatrixXd pose_covariance = table.pca.variance.cwiseMax(0.0).asDiagonal();
  const LinearFeatures features(table,
                                sketch_rows(clusters, pose_covariance, axes_each, weights.alpha3),
                                sketch_rows(clusters, velocity_covariance(table), axes_each, 1.0),
                                static_cast<std::size_t>(kHalf));
  margin_ = features.rounding_margin(weights.alpha3, largest_frame);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < table.nodes.size(); ++i) {
    features.fill_first(static_cast<NodeIndex>(i), first_.data() + i * kFeatures);
    features.fill_last(static_cast<NodeIndex>(i), last_.data() + i * kFeatures);
  }
  first_order_ = order_ends(table, NodeEnd::first, first_);
  last_order_ = order_ends(table, NodeEnd::last, last_);
  first_rank_ = places(first_order_);
  last_rank_ = places(last_order_);
}

} // namespace phonomime
