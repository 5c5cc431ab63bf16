// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_bound.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"
#include "synth/search/group_weights.h"
#include "synth/search/motion_clusters.h"

#include <algorithm>

namespace phonomime {

namespace {

constexpr std::size_t kClusterStride = 16;
constexpr double kRelativeMargin = 1e-5;

// Blendshape weights have one channel a group; more clusters keep them apart.
int cluster_count(const Layout& layout) {
  return std::min(static_cast<int>(kClusterStride), layout.group_count());
}

FrameMatrixD cluster_rows(const MotionTable& table, const CostWeights& weights) {
  const auto axes = static_cast<Eigen::Index>(table.layout.channels_per_group());
  constexpr auto kStride = static_cast<Eigen::Index>(kClusterStride);
  FrameMatrixD rows = FrameMatrixD::Zero(axes * kStride, table.pca.dimension_count());
  const std::vector<Eigen::MatrixXd> clusters =
      cluster_channel_groups(table, weighted_basis(table, weights), cluster_count(table.layout));
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (Eigen::Index axis = 0; axis < axes; ++axis) {
      rows.row(axis * kStride + static_cast<Eigen::Index>(c)) = clusters[c].row(axis);
    }
  }
  return rows;
}

LinearFeatures cluster_features(const MotionTable& table, const CostWeights& weights) {
  const FrameMatrixD rows = cluster_rows(table, weights);
  return {table, weights.alpha3 * rows, rows, static_cast<std::size_t>(rows.rows())};
}

// The sum over clusters of the norm of the difference, of poses and, where those are not enough, of
// velocities.
template <std::size_t kAxes>
inline float summed_end_norms(const float* a, const float* b, float enough) {
  constexpr std::size_t kVelocity = kAxes * kClusterStride;
  const float poses = summed_norms<FloatLanes, kFloatLanes, kAxes>(a, b, kClusterStride);
  if (poses > enough) {
    return poses;
  }
  return poses +
         summed_norms<FloatLanes, kFloatLanes, kAxes>(a + kVelocity, b + kVelocity, kClusterStride);
}

PHONOMIME_DISPATCHED
float summed_cluster_norms(const float* a, const float* b, int axes, float enough) {
  return axes == 3 ? summed_end_norms<3>(a, b, enough) : summed_end_norms<1>(a, b, enough);
}

} // namespace

JoinBound::JoinBound(const MotionTable& table, const CostWeights& weights, double largest_frame)
    : axes_(table.layout.channels_per_group()), features_(cluster_features(table, weights)),
      margin_(features_.rounding_margin(weights.alpha3, largest_frame)),
      records_(table.nodes.size(), 2 * features_.end_floats()) {}

void JoinBound::ensure(std::span<const NodeIndex> nodes) {
  records_.ensure(nodes, [this](NodeIndex node, float* record) {
    features_.fill_first(node, record);
    features_.fill_last(node, record + features_.end_floats());
  });
}

double JoinBound::gaps(NodeIndex from, NodeIndex to, double enough) const {
  constexpr double kCertain = 1.0 - kRelativeMargin;
  const float* last = records_[from] + features_.end_floats();
  const auto most = static_cast<float>((enough + margin_) / kCertain);
  const auto sum = static_cast<double>(summed_cluster_norms(last, records_[to], axes_, most));
  return std::max(0.0, sum * kCertain - margin_);
}

} // namespace phonomime
