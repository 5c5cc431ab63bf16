// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/join_bound.h"

#include "synth/search/vector_dispatch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/SVD>

namespace phonomime {

namespace {

constexpr std::size_t kLanes = 8;
constexpr int kClusters = 16;
constexpr float kRelativeMargin = 1e-5f;

std::size_t padded(int count) {
  return (static_cast<std::size_t>(count) + kLanes - 1) / kLanes * kLanes;
}

// Nearest orthogonal matrix that turns `rows` towards `target` (both 3 by #dimensions).
Eigen::Matrix3d procrustes(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& target) {
  const Eigen::Matrix3d product = target * rows.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

// Cluster of each group, and how each is turned. Farthest-point seeds, then a few rounds of
// assignment to the nearest turned centre: fixed order, no chance.
struct Clustering {
  std::vector<int> cluster;
  std::vector<Eigen::Matrix3d> turn;
};

Clustering cluster_markers(const MotionTable& table) {
  const int groups = table.layout.group_count();
  const Eigen::VectorXd deviation = table.pca.variance.cwiseMax(0.0).cwiseSqrt();
  std::vector<Eigen::MatrixXd> rows;
  for (int g = 0; g < groups; ++g) {
    rows.emplace_back(table.pca.basis.middleRows(3 * g, 3) * deviation.asDiagonal());
  }
  const auto turned_distance = [&](int group, const Eigen::MatrixXd& centre) {
    const Eigen::MatrixXd& own = rows[static_cast<std::size_t>(group)];
    return (procrustes(own, centre) * own - centre).squaredNorm();
  };
  const int count = std::min(kClusters, groups);
  std::vector<Eigen::MatrixXd> centres;
  std::vector<double> distance(static_cast<std::size_t>(groups),
                               std::numeric_limits<double>::infinity());
  int farthest = 0;
  for (int c = 0; c < count; ++c) {
    centres.push_back(rows[static_cast<std::size_t>(farthest)]);
    for (int g = 0; g < groups; ++g) {
      double& nearest = distance[static_cast<std::size_t>(g)];
      nearest = std::min(nearest, turned_distance(g, centres.back()));
    }
    farthest = static_cast<int>(std::ranges::max_element(distance) - distance.begin());
  }
  Clustering result;
  result.cluster.resize(static_cast<std::size_t>(groups));
  result.turn.resize(static_cast<std::size_t>(groups));
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Eigen::MatrixXd> sums(centres.size(),
                                      Eigen::MatrixXd::Zero(3, table.pca.dimension_count()));
    std::vector<int> members(centres.size(), 0);
    for (int g = 0; g < groups; ++g) {
      std::size_t best = 0;
      double best_distance = std::numeric_limits<double>::infinity();
      for (std::size_t c = 0; c < centres.size(); ++c) {
        const double d = turned_distance(g, centres[c]);
        if (d < best_distance) {
          best = c;
          best_distance = d;
        }
      }
      const auto group = static_cast<std::size_t>(g);
      result.cluster[group] = static_cast<int>(best);
      result.turn[group] = procrustes(rows[group], centres[best]);
      sums[best] += result.turn[group] * rows[group];
      ++members[best];
    }
    for (std::size_t c = 0; c < centres.size(); ++c) {
      if (members[c] > 0) {
        centres[c] = sums[c] / members[c];
      }
    }
  }
  return result;
}

// Eight floats that the compiler keeps in vector registers of whatever width there is.
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

inline void load(Lanes& lanes, const float* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}

// The sum over clusters of the norm of the difference, for poses and velocities, in eight lanes:
// cluster k in lane k mod 8.
template <int kAxes>
inline void add_norms(const float* a, const float* b, std::size_t stride, Lanes& sum) {
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t k = 0; k < stride; k += kLanes) {
      Lanes square = {};
      for (int axis = 0; axis < kAxes; ++axis) {
        const std::size_t at = static_cast<std::size_t>(axis) * stride + k;
        Lanes from, to;
        load(from, a + at);
        load(to, b + at);
        const Lanes difference = to - from;
        square += difference * difference;
      }
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        square[lane] = std::sqrt(square[lane]);
      }
      sum += square;
    }
    a += static_cast<std::size_t>(kAxes) * stride;
    b += static_cast<std::size_t>(kAxes) * stride;
  }
}

PHONOMIME_DISPATCHED
void bound_kernel(const float* end, const float* ends, std::size_t count, std::size_t stride,
                  int axes, float margin, float* bounds) {
  const std::size_t end_floats = 2 * static_cast<std::size_t>(axes) * stride;
  for (std::size_t i = 0; i < count; ++i) {
    Lanes sum = {};
    if (axes == 3) {
      add_norms<3>(end, ends + i * end_floats, stride, sum);
    } else {
      add_norms<1>(end, ends + i * end_floats, stride, sum);
    }
    const float total =
        ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
    bounds[i] = std::max(0.0f, total * (1.0f - kRelativeMargin) - margin);
  }
}

} // namespace

JoinBound::JoinBound(const MotionTable& table, const CostWeights& weights)
    : table_(table), alpha3_(weights.alpha3), axes_(table.layout.channels_per_group()),
      cluster_stride_(padded(axes_ == 3 ? std::min(kClusters, table.layout.group_count())
                                        : table.layout.group_count())),
      end_floats_(2 * static_cast<std::size_t>(axes_) * cluster_stride_),
      projection_(FrameMatrixD::Zero(static_cast<Eigen::Index>(end_floats_ / 2),
                                     table.pca.dimension_count())),
      records_(table.nodes.size(), 2 * end_floats_) {
  const auto stride = static_cast<Eigen::Index>(cluster_stride_);
  if (axes_ == 3) {
    const Clustering clustering = cluster_markers(table);
    for (int g = 0; g < table.layout.group_count(); ++g) {
      const auto group = static_cast<std::size_t>(g);
      const Eigen::MatrixXd turned = clustering.turn[group] * table.pca.basis.middleRows(3 * g, 3);
      for (int axis = 0; axis < 3; ++axis) {
        projection_.row(axis * stride + clustering.cluster[group]) += turned.row(axis);
      }
    }
  } else {
    projection_.topRows(table.layout.group_count()) = table.pca.basis;
  }
  // Rounding to float of the full poses that the exact cost compares (largest channel P, four
  // roundings a channel) and of the cluster sums here (largest entry S, three operations each).
  constexpr double kFloatUnit = 0x1p-24;
  const double largest_coefficient =
      table.coefficients.size() == 0
          ? 0.0
          : static_cast<double>(table.coefficients.rowwise().norm().maxCoeff());
  const double pose = table.pca.mean.cwiseAbs().maxCoeff() + largest_coefficient;
  const double velocity = 2.0 * largest_coefficient * table.rate_hz;
  const double cluster = projection_.rowwise().norm().maxCoeff() * largest_coefficient;
  const double cluster_velocity = 2.0 * cluster * table.rate_hz;
  const double per_channel = alpha3_ * pose + velocity;
  const double per_cluster = alpha3_ * cluster + cluster_velocity;
  margin_ = static_cast<float>(4.0 * kFloatUnit *
                               (per_channel * table.layout.channel_count() +
                                per_cluster * static_cast<double>(projection_.rows())));
}

void JoinBound::ensure(std::span<const NodeIndex> nodes) {
  records_.ensure(nodes, [this](NodeIndex node, float* record) {
    const MotionNode& info = table_.nodes[static_cast<std::size_t>(node)];
    const std::int64_t begin = info.first_frame;
    const std::int64_t end = begin + info.frame_count - 1;
    fill_end(record, begin, begin, std::min(begin + 1, end));
    fill_end(record + end_floats_, end, std::max(end - 1, begin), end);
  });
}

void JoinBound::fill_end(float* record, std::int64_t edge, std::int64_t before,
                         std::int64_t after) const {
  const auto at = table_.coefficients.row(edge);
  const auto from = table_.coefficients.row(before);
  const auto to = table_.coefficients.row(after);
  const std::size_t half = end_floats_ / 2;
  for (Eigen::Index row = 0; row < projection_.rows(); ++row) {
    double pose = 0.0;
    double velocity = 0.0;
    for (Eigen::Index k = 0; k < projection_.cols(); ++k) {
      const double weight = projection_(row, k);
      pose += weight * static_cast<double>(at[k]);
      velocity += weight * (static_cast<double>(to[k]) - static_cast<double>(from[k]));
    }
    record[row] = static_cast<float>(alpha3_ * pose);
    record[half + static_cast<std::size_t>(row)] = static_cast<float>(velocity * table_.rate_hz);
  }
}

void JoinBound::bound(const float* end, std::span<const float> ends,
                      std::span<float> bounds) const {
  bound_kernel(end, ends.data(), bounds.size(), cluster_stride_, axes_, margin_, bounds.data());
}

} // namespace phonomime
