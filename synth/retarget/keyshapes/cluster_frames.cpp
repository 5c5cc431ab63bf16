// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/cluster_frames.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace phonomime {
namespace {

constexpr int kMostRounds = 300;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A centre each: the first by lot, each further one by lot with chances as the squared distance to
// those before it.
FrameMatrixD seeded_centres(const FrameMatrixD& points, int count, std::uint64_t seed) {
  std::mt19937_64 draw(seed);
  const auto lot = [&] { return static_cast<double>(draw() >> 11) * 0x1p-53; }; // [0, 1)
  FrameMatrixD centres(count, points.cols());
  Eigen::VectorXd distance_sq = Eigen::VectorXd::Constant(points.rows(), 1.0);
  for (int k = 0; k < count; ++k) {
    const double total = distance_sq.sum();
    if (total == 0.0) {
      return centres.topRows(k);
    }
    double left = lot() * total;
    Eigen::Index chosen = 0;
    Eigen::Index last_possible = 0;
    for (; chosen < points.rows(); ++chosen) {
      last_possible = distance_sq[chosen] > 0.0 ? chosen : last_possible;
      left -= distance_sq[chosen];
      if (left < 0.0 && distance_sq[chosen] > 0.0) {
        break;
      }
    }
    centres.row(k) = points.row(std::min(chosen, last_possible));
    const Eigen::VectorXd to_new = (points.rowwise() - centres.row(k)).rowwise().squaredNorm();
    distance_sq = k == 0 ? to_new : distance_sq.cwiseMin(to_new).eval();
  }
  return centres;
}

// The centre nearest each point, ties to the first. True where any changed.
bool assign(const FrameMatrixD& points, const FrameMatrixD& centres, std::vector<int>& nearest) {
  bool changed = false;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    Eigen::Index best = 0;
    (centres.rowwise() - points.row(i)).rowwise().squaredNorm().minCoeff(&best);
    int& own = nearest[static_cast<std::size_t>(i)];
    changed |= own != static_cast<int>(best);
    own = static_cast<int>(best);
  }
  return changed;
}

} // namespace

std::vector<Eigen::Index> cluster_frames(const FrameMatrixD& points, int count,
                                         std::uint64_t seed) {
  if (points.rows() == 0 || count < 1) {
    return {};
  }
  FrameMatrixD centres = seeded_centres(points, count, seed);
  const auto clusters = static_cast<std::size_t>(centres.rows());
  std::vector<int> nearest(static_cast<std::size_t>(points.rows()), -1);
  std::vector<Eigen::Index> sizes(clusters);
  for (int round = 0; round < kMostRounds && assign(points, centres, nearest); ++round) {
    FrameMatrixD sums = FrameMatrixD::Zero(centres.rows(), centres.cols());
    std::ranges::fill(sizes, Eigen::Index{0});
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const auto own = static_cast<std::size_t>(nearest[static_cast<std::size_t>(i)]);
      sums.row(static_cast<Eigen::Index>(own)) += points.row(i);
      ++sizes[own];
    }
    for (std::size_t k = 0; k < clusters; ++k) { // one that lost all its frames stays
      if (sizes[k] > 0) {
        const auto row = static_cast<Eigen::Index>(k);
        centres.row(row) = sums.row(row) / static_cast<double>(sizes[k]);
      }
    }
  }
  std::vector<std::size_t> order(clusters);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t k) { return sizes[k]; });
  std::vector<Eigen::Index> frames;
  for (const std::size_t k : order) {
    Eigen::Index best = -1;
    double best_sq = kInfinity;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (nearest[static_cast<std::size_t>(i)] != static_cast<int>(k)) {
        continue;
      }
      const double distance_sq =
          (points.row(i) - centres.row(static_cast<Eigen::Index>(k))).squaredNorm();
      if (distance_sq < best_sq) {
        best = i;
        best_sq = distance_sq;
      }
    }
    if (best >= 0) {
      frames.push_back(best);
    }
  }
  return frames;
}

} // namespace phonomime
