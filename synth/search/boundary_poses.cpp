// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/boundary_poses.h"

#include <algorithm>

namespace phonomime {

namespace {

constexpr std::size_t kLanes = 4;

std::size_t padded(int groups) {
  return (static_cast<std::size_t>(groups) + kLanes - 1) / kLanes * kLanes;
}

} // namespace

BoundaryPoses::BoundaryPoses(const MotionTable& table)
    : table_(table), basis_(table.pca.basis),
      channels_per_group_(table.layout.channels_per_group()),
      group_stride_(padded(table.layout.group_count())),
      end_floats_(2 * static_cast<std::size_t>(channels_per_group_) * group_stride_),
      records_(table.nodes.size(), 2 * end_floats_) {}

void BoundaryPoses::ensure(std::span<const NodeIndex> nodes) {
  records_.ensure(nodes, [this](NodeIndex node, float* record) {
    const MotionNode& info = table_.nodes[static_cast<std::size_t>(node)];
    const std::int64_t begin = info.first_frame;
    const std::int64_t end = begin + info.frame_count - 1;
    fill_end(record, begin, begin, std::min(begin + 1, end));
    fill_end(record + end_floats_, end, std::max(end - 1, begin), end);
  });
}

// The order of the sum is part of the cost's definition.
double BoundaryPoses::reconstruct(Eigen::Index channel, const float* coefficients) const {
  const double* row = basis_.data() + channel * basis_.cols();
  double sum = table_.pca.mean[channel];
  for (Eigen::Index k = 0; k < basis_.cols(); ++k) {
    sum += row[k] * static_cast<double>(coefficients[k]);
  }
  return sum;
}

void BoundaryPoses::fill_end(float* record, std::int64_t edge, std::int64_t before,
                             std::int64_t after) const {
  const float* coefficients_before = table_.coefficients.row(before).data();
  const float* coefficients_after = table_.coefficients.row(after).data();
  for (Eigen::Index c = 0; c < table_.pca.channel_count(); ++c) {
    const double channel_before = reconstruct(c, coefficients_before);
    const double channel_after = reconstruct(c, coefficients_after);
    const auto group = static_cast<std::size_t>(c / channels_per_group_);
    const auto axis = static_cast<std::size_t>(c % channels_per_group_);
    const auto velocity_axis = axis + static_cast<std::size_t>(channels_per_group_);
    record[axis * group_stride_ + group] =
        static_cast<float>(edge == before ? channel_before : channel_after);
    record[velocity_axis * group_stride_ + group] =
        static_cast<float>((channel_after - channel_before) * table_.rate_hz);
  }
}

} // namespace phonomime
