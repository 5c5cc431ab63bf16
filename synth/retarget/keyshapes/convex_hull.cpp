// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/convex_hull.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <CGAL/Convex_hull_traits_adapter_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>
#include <CGAL/property_map.h>

namespace phonomime {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

} // namespace

std::vector<Eigen::Index> convex_hull(const FrameMatrixD& points) {
  std::vector<Kernel::Point_2> places;
  places.reserve(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    places.emplace_back(points(i, 0), points.cols() > 1 ? points(i, 1) : 0.0);
  }
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {},
                    [&](std::size_t i) { return std::tuple(places[i].x(), places[i].y(), i); });
  const auto last = std::unique(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return places[a] == places[b];
  });
  order.erase(last, order.end());
  std::vector<std::size_t> corners;
  const CGAL::Convex_hull_traits_adapter_2<Kernel,
                                           CGAL::Pointer_property_map<Kernel::Point_2>::type>
      traits(CGAL::make_property_map(places));
  CGAL::convex_hull_2(order.begin(), order.end(), std::back_inserter(corners), traits);
  return {corners.begin(), corners.end()};
}

} // namespace phonomime
