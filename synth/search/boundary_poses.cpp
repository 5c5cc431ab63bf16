// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/boundary_poses.h"

#include "synth/search/vector_dispatch.h"

#include <algorithm>
#include <vector>

namespace phonomime {

namespace {

constexpr std::size_t kLanes = 8; // what the kernels that read poses take at a time

std::size_t padded(int groups) {
  return (static_cast<std::size_t>(groups) + kLanes - 1) / kLanes * kLanes;
}

// E11 for all channels at once. The order of each channel's sum is part of the cost's definition.
PHONOMIME_DISPATCHED
void reconstruct(const double* mean, const double* basis, const float* coefficients,
                 std::size_t dimensions, std::size_t channels, double* pose) {
  std::copy(mean, mean + channels, pose);
  for (std::size_t k = 0; k < dimensions; ++k) {
    const double* row = basis + k * channels;
    const double coefficient = coefficients[k];
    for (std::size_t c = 0; c < channels; ++c) {
      pose[c] += row[c] * coefficient;
    }
  }
}

} // namespace

BoundaryPoses::BoundaryPoses(const MotionTable& table)
    : table_(table), channels_per_group_(table.layout.channels_per_group()),
      group_stride_(padded(table.layout.group_count())),
      planes_(static_cast<std::size_t>(channels_per_group_) * group_stride_),
      mean_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(planes_))),
      basis_(FrameMatrixD::Zero(table.pca.dimension_count(), static_cast<Eigen::Index>(planes_))),
      records_(table.nodes.size(), 4 * planes_) {
  for (Eigen::Index c = 0; c < table.pca.channel_count(); ++c) {
    const Eigen::Index place = c % channels_per_group_ * static_cast<Eigen::Index>(group_stride_) +
                               c / channels_per_group_;
    mean_[place] = table.pca.mean[c];
    basis_.col(place) = table.pca.basis.row(c).transpose();
  }
}

void BoundaryPoses::ensure(std::span<const NodeIndex> nodes) {
  records_.ensure(nodes, [this](NodeIndex node, float* record) {
    const MotionNode& info = table_.nodes[static_cast<std::size_t>(node)];
    const std::int64_t begin = info.first_frame;
    const std::int64_t end = begin + info.frame_count - 1;
    std::vector<double> room(2 * planes_);
    fill_end(record, begin, begin, std::min(begin + 1, end), room.data());
    fill_end(record + 2 * planes_, end, std::max(end - 1, begin), end, room.data());
  });
}

void BoundaryPoses::fill_end(float* record, std::int64_t edge, std::int64_t before,
                             std::int64_t after, double* room) const {
  const auto dimensions = static_cast<std::size_t>(basis_.rows());
  double* pose_before = room;
  double* pose_after = room + planes_;
  reconstruct(mean_.data(), basis_.data(), table_.coefficients.row(before).data(), dimensions,
              planes_, pose_before);
  reconstruct(mean_.data(), basis_.data(), table_.coefficients.row(after).data(), dimensions,
              planes_, pose_after);
  const double* pose = edge == before ? pose_before : pose_after;
  for (std::size_t i = 0; i < planes_; ++i) {
    record[i] = static_cast<float>(pose[i]);
    record[planes_ + i] = static_cast<float>((pose_after[i] - pose_before[i]) * table_.rate_hz);
  }
}

} // namespace phonomime
