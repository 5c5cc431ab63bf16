// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/boundary_poses.h"

#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"
#include "synth/search/group_weights.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace phonomime {

namespace {

constexpr std::size_t kLanes = 8; // what the kernels that read poses take at a time

std::size_t padded(int groups) {
  return (static_cast<std::size_t>(groups) + kLanes - 1) / kLanes * kLanes;
}

constexpr std::size_t kUsualPlanes = 512; // as many channels and dimensions need no allocation
constexpr std::size_t kUsualDimensions = 64;
constexpr std::size_t kFrames = 4; // of a node: the two at its start, the two at its end

// E11 of four frames for all channels (a multiple of eight). The order of each channel's sum is
// part of the cost's definition: ((mean + e0 c0) + e1 c1) + ... `coefficients`: #dimensions by
// kFrames.
PHONOMIME_DISPATCHED
void reconstruct(const double* mean, const double* basis, const double* coefficients,
                 std::size_t dimensions, std::size_t channels, double* poses) {
  constexpr std::size_t kBoth = 2 * kDoubleLanes;
  for (std::size_t c = 0; c < channels; c += kBoth) {
    DoubleLanes left[kFrames], right[kFrames];
    for (std::size_t f = 0; f < kFrames; ++f) {
      load(left[f], mean + c);
      load(right[f], mean + c + kDoubleLanes);
    }
    for (std::size_t k = 0; k < dimensions; ++k) {
      DoubleLanes left_row, right_row;
      load(left_row, basis + k * channels + c);
      load(right_row, basis + k * channels + c + kDoubleLanes);
      for (std::size_t f = 0; f < kFrames; ++f) {
        const double coefficient = coefficients[k * kFrames + f];
        left[f] += left_row * coefficient;
        right[f] += right_row * coefficient;
      }
    }
    for (std::size_t f = 0; f < kFrames; ++f) {
      std::memcpy(poses + f * channels + c, &left[f], sizeof left[f]);
      std::memcpy(poses + f * channels + c + kDoubleLanes, &right[f], sizeof right[f]);
    }
  }
}

// Pose and velocity of one end, to float.
PHONOMIME_DISPATCHED
void write_end(const double* edge, const double* before, const double* after, double rate_hz,
               std::size_t channels, float* record) {
  for (std::size_t c = 0; c < channels; ++c) {
    record[c] = static_cast<float>(edge[c]);
    record[channels + c] = static_cast<float>((after[c] - before[c]) * rate_hz);
  }
}

} // namespace

BoundaryPoses::BoundaryPoses(const MotionTable& table, const CostWeights& weights)
    : table_(table), channels_per_group_(table.layout.channels_per_group()),
      group_stride_(padded(table.layout.group_count())),
      planes_(static_cast<std::size_t>(channels_per_group_) * group_stride_),
      mean_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(planes_))),
      basis_(FrameMatrixD::Zero(table.pca.dimension_count(), static_cast<Eigen::Index>(planes_))),
      records_(table.nodes.size(), 4 * planes_) {
  const Eigen::MatrixXd basis = weighted_basis(table, weights);
  for (Eigen::Index c = 0; c < table.pca.channel_count(); ++c) {
    const Eigen::Index place = c % channels_per_group_ * static_cast<Eigen::Index>(group_stride_) +
                               c / channels_per_group_;
    mean_[place] = table.pca.mean[c];
    basis_.col(place) = basis.row(c).transpose();
  }
}

void BoundaryPoses::ensure(std::span<const NodeIndex> nodes) {
  records_.ensure(nodes, [this](NodeIndex node, float* record) {
    const MotionNode& info = table_.nodes[static_cast<std::size_t>(node)];
    const std::int64_t begin = info.first_frame;
    const std::int64_t end = begin + info.frame_count - 1;
    const auto row = [&](std::int64_t frame) { return table_.coefficients.row(frame).data(); };
    const std::array<const float*, kFrames> frames = {row(begin), row(std::min(begin + 1, end)),
                                                      row(std::max(end - 1, begin)), row(end)};
    const auto dimensions = static_cast<std::size_t>(basis_.rows());
    std::array<double, kFrames*(kUsualPlanes + kUsualDimensions)> usual;
    std::vector<double> large;
    double* room = usual.data();
    if (planes_ > kUsualPlanes || dimensions > kUsualDimensions) {
      large.resize(kFrames * (planes_ + dimensions));
      room = large.data();
    }
    double* poses = room;
    double* coefficients = room + kFrames * planes_;
    for (std::size_t k = 0; k < dimensions; ++k) {
      for (std::size_t f = 0; f < kFrames; ++f) {
        coefficients[k * kFrames + f] = static_cast<double>(frames[f][k]);
      }
    }
    reconstruct(mean_.data(), basis_.data(), coefficients, dimensions, planes_, poses);
    const double* last = poses + 2 * planes_;
    write_end(poses, poses, poses + planes_, table_.rate_hz, planes_, record);
    write_end(last + planes_, last, last + planes_, table_.rate_hz, planes_, record + 2 * planes_);
  });
}

} // namespace phonomime
