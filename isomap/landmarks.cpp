// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/landmarks.h"

#include "db/types/parallel_for.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace phonomime {

std::vector<std::int32_t> choose_landmarks(std::int32_t point_count, std::int32_t count,
                                           std::uint64_t seed) {
  std::vector<std::int32_t> chosen(static_cast<std::size_t>(std::min(point_count, count)));
  if (point_count <= count) {
    std::iota(chosen.begin(), chosen.end(), 0);
    return chosen;
  }
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto begin = static_cast<std::int64_t>(i) * point_count / count;
    const auto end = static_cast<std::int64_t>(i + 1) * point_count / count;
    const auto offset = random() % static_cast<std::uint64_t>(end - begin);
    chosen[i] = static_cast<std::int32_t>(begin + static_cast<std::int64_t>(offset));
  }
  return chosen;
}

MapPlaces place_by_landmarks(const DistanceMatrix& distances,
                             std::span<const std::int32_t> landmarks, const ScaledPlaces& scaled,
                             int threads) {
  const Eigen::Index landmark_count = distances.rows();
  Eigen::VectorXd mean_sq = Eigen::VectorXd::Zero(landmark_count);
  MapPlaces pseudo_inverse = MapPlaces::Zero(landmark_count, 2);
  for (Eigen::Index l = 0; l < landmark_count; ++l) {
    for (const std::int32_t other : landmarks) {
      mean_sq[l] += distances(l, other) * distances(l, other);
    }
    mean_sq[l] /= static_cast<double>(landmark_count);
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const double eigenvalue = scaled.eigenvalues[static_cast<std::size_t>(axis)];
      pseudo_inverse(l, axis) = eigenvalue > 0.0 ? scaled.places(l, axis) / eigenvalue : 0.0;
    }
  }
  constexpr Eigen::Index kPointsAtOnce = 1024; // a thread's share
  MapPlaces places = MapPlaces::Zero(distances.cols(), 2);
  parallel_for((distances.cols() + kPointsAtOnce - 1) / kPointsAtOnce, threads,
               [&](std::ptrdiff_t share) {
                 const Eigen::Index first = share * kPointsAtOnce;
                 const Eigen::Index end = std::min(first + kPointsAtOnce, distances.cols());
                 for (Eigen::Index l = 0; l < landmark_count; ++l) {
                   for (Eigen::Index i = first; i < end; ++i) {
                     const double offset = distances(l, i) * distances(l, i) - mean_sq[l];
                     places.row(i) -= 0.5 * offset * pseudo_inverse.row(l);
                   }
                 }
               });
  centre_and_align(places);
  return places;
}

} // namespace phonomime
