// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/residual_variance.h"

#include "db/types/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace phonomime {

namespace {

// Sums over pairs of x (on the map) and y (along the graph), about a centre near their means.
struct Moments {
  double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  void add(double a, double b) {
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  void add(const Moments& other) {
    x += other.x;
    y += other.y;
    xx += other.xx;
    yy += other.yy;
    xy += other.xy;
  }
};

double distance(const MapPlaces& places, Eigen::Index a, Eigen::Index b) {
  const double dx = places(a, 0) - places(b, 0);
  const double dy = places(a, 1) - places(b, 1);
  return std::sqrt(dx * dx + dy * dy);
}

} // namespace

double residual_variance(const DistanceMatrix& distances, std::span<const std::int32_t> sources,
                         const MapPlaces& places, int threads) {
  const auto source_count = static_cast<std::ptrdiff_t>(sources.size());
  const Eigen::Index point_count = places.rows();
  if (source_count == 0 || point_count == 0) {
    return 0.0;
  }
  const auto sums_about = [&](double centre_x, double centre_y) {
    std::vector<Moments> rows(sources.size());
    parallel_for(source_count, threads, [&](std::ptrdiff_t s) {
      Moments moments;
      const auto source = sources[static_cast<std::size_t>(s)];
      for (Eigen::Index j = 0; j < point_count; ++j) {
        moments.add(distance(places, source, j) - centre_x, distances(s, j) - centre_y);
      }
      rows[static_cast<std::size_t>(s)] = moments;
    });
    Moments sum;
    for (const Moments& row : rows) {
      sum.add(row);
    }
    return sum;
  };
  const double count = static_cast<double>(source_count) * static_cast<double>(point_count);
  const Moments means = sums_about(0.0, 0.0);
  const Moments about = sums_about(means.x / count, means.y / count);
  const double variance_x = about.xx - about.x * about.x / count;
  const double variance_y = about.yy - about.y * about.y / count;
  if (variance_x <= 0.0 || variance_y <= 0.0) {
    return variance_x <= 0.0 && variance_y <= 0.0 ? 0.0 : 1.0;
  }
  const double covariance = about.xy - about.x * about.y / count;
  return std::clamp(1.0 - covariance * covariance / (variance_x * variance_y), 0.0, 1.0);
}

} // namespace phonomime
