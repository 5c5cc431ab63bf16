// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/motion_clusters.h"

#include <algorithm>
#include <limits>

#include <Eigen/SVD>

namespace phonomime {

namespace {

// Orthogonal matrix that turns `rows` towards `target` (both #axes by #dimensions) best.
Eigen::MatrixXd procrustes(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& target) {
  const Eigen::MatrixXd product = target * rows.transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

double turned_distance(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& centre) {
  return (procrustes(rows, centre) * rows - centre).squaredNorm();
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
      distance[g] = std::min(distance[g], turned_distance(rows[g], centres.back()));
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
    const double distance = turned_distance(rows, centres[c]);
    if (distance < best_distance) {
      best = c;
      best_distance = distance;
    }
  }
  return best;
}

} // namespace

std::vector<Eigen::MatrixXd> cluster_channel_groups(const MotionTable& table, int count) {
  const int axes = table.layout.channels_per_group();
  const Eigen::VectorXd deviation = table.pca.variance.cwiseMax(0.0).cwiseSqrt();
  std::vector<Eigen::MatrixXd> rows;
  for (int g = 0; g < table.layout.group_count(); ++g) {
    rows.emplace_back(table.pca.basis.middleRows(axes * g, axes) * deviation.asDiagonal());
  }
  const auto clusters = static_cast<std::size_t>(std::clamp(count, 1, table.layout.group_count()));
  std::vector<Eigen::MatrixXd> centres = seed_centres(rows, clusters);
  std::vector<Eigen::MatrixXd> projections;
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(axes, table.pca.dimension_count());
    std::vector<Eigen::MatrixXd> sums(clusters, zero);
    std::vector<int> members(clusters, 0);
    projections.assign(clusters, zero);
    for (std::size_t g = 0; g < rows.size(); ++g) {
      const std::size_t c = nearest_centre(rows[g], centres);
      const Eigen::MatrixXd turn = procrustes(rows[g], centres[c]);
      sums[c] += turn * rows[g];
      ++members[c];
      projections[c] += turn * table.pca.basis.middleRows(axes * static_cast<int>(g), axes);
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
