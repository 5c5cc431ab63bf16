// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/residual_variance.h"

#include "db/types/parallel_for.h"
#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace phonomime {

namespace {

// Sums over pairs of x (on the map) and y (along the graph), about a centre near their means.
template <typename Number>
struct Moments {
  Number x = {}, y = {}, xx = {}, yy = {}, xy = {};
  void add(const Number& a, const Number& b) {
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

struct Place {
  double x = 0.0, y = 0.0;
};

double distance(const Place& from, double x, double y) {
  const double dx = x - from.x, dy = y - from.y;
  return std::sqrt(dx * dx + dy * dy);
}

// Of a source at `from` and all places; `along`: its #places distances.
PHONOMIME_DISPATCHED Moments<double> row_moments(const Place& from, const double* x,
                                                 const double* y, const double* along,
                                                 std::size_t count, const Place& centre) {
  Moments<DoubleLanes> lanes;
  std::size_t j = 0;
  for (; j + kDoubleLanes <= count; j += kDoubleLanes) {
    DoubleLanes dx, dy, length;
    load(dx, x + j);
    load(dy, y + j);
    load(length, along + j);
    dx -= from.x;
    dy -= from.y;
    DoubleLanes shown = dx * dx + dy * dy;
    take_roots(shown);
    lanes.add(shown - centre.x, length - centre.y);
  }
  Moments<double> sum;
  for (; j < count; ++j) {
    sum.add(distance(from, x[j], y[j]) - centre.x, along[j] - centre.y);
  }
  sum.add({sum_of_lanes(lanes.x), sum_of_lanes(lanes.y), sum_of_lanes(lanes.xx),
           sum_of_lanes(lanes.yy), sum_of_lanes(lanes.xy)});
  return sum;
}

} // namespace

double residual_variance(const DistanceMatrix& distances, std::span<const std::int32_t> sources,
                         const MapPlaces& places, int threads) {
  const auto source_count = static_cast<std::ptrdiff_t>(sources.size());
  const Eigen::Index point_count = places.rows();
  if (source_count == 0 || point_count == 0) {
    return 0.0;
  }
  const Eigen::ArrayXd x = places.col(0), y = places.col(1);
  const auto moments_of = [&](std::size_t s, const Place& centre) {
    const Eigen::Index at = sources[s];
    return row_moments({x[at], y[at]}, x.data(), y.data(),
                       distances.row(static_cast<Eigen::Index>(s)).data(),
                       static_cast<std::size_t>(point_count), centre);
  };
  // About the means of one source's distances, so that little cancels.
  const Moments<double> some = moments_of(sources.size() / 2, {});
  const Place centre = {some.x / static_cast<double>(point_count),
                        some.y / static_cast<double>(point_count)};
  std::vector<Moments<double>> rows(sources.size());
  parallel_for(source_count, threads, [&](std::ptrdiff_t s) {
    rows[static_cast<std::size_t>(s)] = moments_of(static_cast<std::size_t>(s), centre);
  });
  Moments<double> about;
  for (const Moments<double>& row : rows) {
    about.add(row);
  }
  const double count = static_cast<double>(source_count) * static_cast<double>(point_count);
  const double variance_x = about.xx - about.x * about.x / count;
  const double variance_y = about.yy - about.y * about.y / count;
  if (variance_x <= 0.0 || variance_y <= 0.0) {
    return variance_x <= 0.0 && variance_y <= 0.0 ? 0.0 : 1.0;
  }
  const double covariance = about.xy - about.x * about.y / count;
  return std::clamp(1.0 - covariance * covariance / (variance_x * variance_y), 0.0, 1.0);
}

} // namespace phonomime
