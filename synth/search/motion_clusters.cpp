// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/motion_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SVD>

namespace phonomime {

namespace {

// What is left of the squared distance of `rows` from `target` (both #axes by #dimensions) when an
// orthogonal matrix turns them towards it as well as can be.
double turned_distance_sq(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& target) {
  const double norms = rows.squaredNorm() + target.squaredNorm();
  if (rows.rows() == 1) {
    return norms - 2.0 * std::abs((target * rows.transpose())(0, 0));
  }
  const Eigen::Matrix3d product = target * rows.transpose();
  return norms - 2.0 * Eigen::JacobiSVD<Eigen::Matrix3d>(product).singularValues().sum();
}

// That matrix (Procrustes).
Eigen::MatrixXd turn_towards(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& target) {
  if (rows.rows() == 1) {
    const double product = (target * rows.transpose())(0, 0);
    return Eigen::MatrixXd::Constant(1, 1, product < 0.0 ? -1.0 : 1.0);
  }
  const Eigen::Matrix3d product = target * rows.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

// Farthest-point seeds: fixed order, no chance.
std::vector<Eigen::MatrixXd> seed_centres(const std::vector<Eigen::MatrixXd>& rows,
                                          std::size_t count) {
  std::vector<Eigen::MatrixXd> centres;
  std::vector<double> distance(rows.size(), std::numeric_limits<double>::infinity());
  std::size_t farthest = 0;
  while (centres.size() < count) {
    centres.push_back(rows[farthest]);
    for (std::size_t g = 0; g < rows.size(); ++g) {
      distance[g] = std::min(distance[g], turned_distance_sq(rows[g], centres.back()));
    }
    farthest = static_cast<std::size_t>(std::ranges::max_element(distance) - distance.begin());
  }
  return centres;
}

std::size_t nearest_centre(const Eigen::MatrixXd& rows,
                           const std::vector<Eigen::MatrixXd>& centres) {
  std::size_t best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < centres.size(); ++c) {
    const double distance = turned_distance_sq(rows, centres[c]);
    if (distance < best_distance) {
      best = c;
      best_distance = distance;
    }
  }
  return best;
}

} // namespace

std::vector<Eigen::MatrixXd> cluster_channel_groups(const MotionTable& table,
                                                    const Eigen::MatrixXd& basis, int count) {
  const int axes = table.layout.channels_per_group();
  const Eigen::VectorXd deviation = table.pca.variance.cwiseMax(0.0).cwiseSqrt();
  std::vector<Eigen::MatrixXd> rows;
  for (int g = 0; g < table.layout.group_count(); ++g) {
    rows.emplace_back(basis.middleRows(axes * g, axes) * deviation.asDiagonal());
  }
  const auto clusters = static_cast<std::size_t>(std::clamp(count, 1, table.layout.group_count()));
  std::vector<Eigen::MatrixXd> centres = seed_centres(rows, clusters);
  std::vector<Eigen::MatrixXd> projections;
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(axes, table.pca.dimension_count());
    std::vector<Eigen::MatrixXd> sums(clusters, zero);
    std::vector<int> members(clusters, 0);
    projections.assign(clusters, zero);
    std::vector<std::size_t> cluster_of(rows.size());
#pragma omp parallel for schedule(static)
    for (std::size_t g = 0; g < rows.size(); ++g) {
      cluster_of[g] = nearest_centre(rows[g], centres);
    }
    for (std::size_t g = 0; g < rows.size(); ++g) {
      const std::size_t c = cluster_of[g];
      const Eigen::MatrixXd turn = turn_towards(rows[g], centres[c]);
      sums[c] += turn * rows[g];
      ++members[c];
      projections[c] += turn * basis.middleRows(axes * static_cast<int>(g), axes);
    }
    for (std::size_t c = 0; c < clusters; ++c) {
      if (members[c] > 0) {
        centres[c] = sums[c] / members[c];
      }
    }
  }
  return projections;
}

} // namespace phonomime
