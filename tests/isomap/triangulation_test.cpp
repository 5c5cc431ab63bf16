// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/triangulation.h"
#include "tests/isomap/point_sets.h"
#include "tests/support/expect_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

using Corners = std::array<std::int32_t, 3>;
using Point = std::array<double, 2>;

long double turn(const Point& a, const Point& b, const Point& c) {
  return (static_cast<long double>(b[0]) - a[0]) * (static_cast<long double>(c[1]) - a[1]) -
         (static_cast<long double>(c[0]) - a[0]) * (static_cast<long double>(b[1]) - a[1]);
}

Point at(const MapPlaces& places, std::int32_t i) {
  return {places(i, 0), places(i, 1)};
}

// The triangles that cover a place, corners ascending, by looking at each.
std::vector<Corners> covering(const MapTriangulation& map, const Point& p) {
  std::vector<Corners> found;
  for (Corners t : map.triangles()) {
    const Point a = at(map.places(), t[0]), b = at(map.places(), t[1]), c = at(map.places(), t[2]);
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) {
      std::sort(t.begin(), t.end());
      found.push_back(t);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::int32_t nearest(const MapPlaces& places, const Point& p) {
  Eigen::Index row = -1;
  (places.rowwise() - Eigen::RowVector2d(p[0], p[1])).rowwise().squaredNorm().minCoeff(&row);
  return static_cast<std::int32_t>(row);
}

void expect_right(const MapTriangulation& map, const Point& p) {
  SCOPED_TRACE(testing::Message() << p[0] << " " << p[1]);
  const PickedFrame picked = map.pick(p[0], p[1]);
  const std::vector<Corners> expected = covering(map, p);
  EXPECT_EQ(picked.nearest, nearest(map.places(), p));
  EXPECT_NEAR(
      picked.nearest_distance,
      std::hypot(map.places()(picked.nearest, 0) - p[0], map.places()(picked.nearest, 1) - p[1]),
      1e-12);
  ASSERT_EQ(picked.inside, !expected.empty());
  if (!picked.inside) {
    EXPECT_EQ(picked.corners, (Corners{picked.nearest, picked.nearest, picked.nearest}));
    EXPECT_EQ(picked.weights, (std::array<double, 3>{1.0, 0.0, 0.0}));
    return;
  }
  EXPECT_EQ(picked.corners, expected.front());
  Eigen::RowVector2d place = Eigen::RowVector2d::Zero();
  double sum = 0.0;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    EXPECT_GE(picked.weights[corner], 0.0);
    sum += picked.weights[corner];
    place += picked.weights[corner] * map.places().row(picked.corners[corner]);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(place[0], p[0], 1e-9);
  EXPECT_NEAR(place[1], p[1], 1e-9);
}

MapPlaces random_places(std::mt19937& random, int count) {
  return test::uniform_points(random, count, 2).cast<double>();
}

TEST(Triangulation, PicksWhatEveryTriangleLookedAtGives) {
  std::mt19937 random(71);
  for (const int count : {3, 4, 10, 200}) {
    const MapTriangulation map(random_places(random, count));
    std::uniform_real_distribution<double> coordinate(-0.3, 1.3);
    for (int i = 0; i < 300; ++i) {
      expect_right(map, {coordinate(random), coordinate(random)});
    }
  }
}

TEST(Triangulation, PicksOnEdgesAndCorners) {
  std::mt19937 random(72);
  MapPlaces grid(49, 2); // every square's diagonal could go either way
  for (Eigen::Index i = 0; i < 49; ++i) {
    grid.row(i) << static_cast<double>(i % 7), static_cast<double>(i / 7);
  }
  const MapTriangulation map(grid);
  EXPECT_EQ(map.triangles().size(), 72U);
  for (int y = 0; y <= 12; ++y) {
    for (int x = 0; x <= 12; ++x) {
      expect_right(map, {0.5 * x, 0.5 * y});
    }
  }
  for (std::int32_t i = 0; i < 49; ++i) {
    const PickedFrame picked = map.pick(grid(i, 0), grid(i, 1));
    EXPECT_TRUE(picked.inside);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(picked.weights[corner], picked.corners[corner] == i ? 1.0 : 0.0);
    }
  }
}

TEST(Triangulation, IsDelaunay) {
  std::mt19937 random(73);
  const MapTriangulation map(random_places(random, 150));
  double area = 0.0;
  for (const Corners& t : map.triangles()) {
    EXPECT_LT(t[0], std::min(t[1], t[2]));
    const Point a = at(map.places(), t[0]), b = at(map.places(), t[1]), c = at(map.places(), t[2]);
    EXPECT_GT(turn(a, b, c), 0);
    area += 0.5 * static_cast<double>(turn(a, b, c));
    Eigen::Matrix2d sides;
    sides << b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1];
    const Eigen::Vector2d centre =
        sides.inverse() * 0.5 * sides.rowwise().squaredNorm(); // of the circle, from a
    for (Eigen::Index i = 0; i < 150; ++i) {
      const double distance =
          (map.places().row(i).transpose() - Eigen::Vector2d(a[0], a[1]) - centre).norm();
      EXPECT_GE(distance, centre.norm() * (1.0 - 1e-9));
    }
  }
  EXPECT_GT(area, 0.8);
}

TEST(Triangulation, TakesTheFirstOfPointsAtOnePlace) {
  MapPlaces places(7, 2);
  places << 0, 0, 4, 0, 4, 0, 0, 4, 0, 0, 4, 0, 1, 1;
  const MapTriangulation map(places);
  for (const Corners& corners : map.triangles()) {
    for (const std::int32_t corner : corners) {
      EXPECT_TRUE(corner == 0 || corner == 1 || corner == 3 || corner == 6) << corner;
    }
  }
  expect_right(map, {3.9, 0.01});
  EXPECT_EQ(map.pick(5.0, 0.0).nearest, 1);
}

TEST(Triangulation, OfALineOrAPointGivesTheNearest) {
  MapPlaces line(5, 2);
  line << 0, 0, 1, 1, 2, 2, 3, 3, 4, 4;
  const MapTriangulation on_line(line);
  EXPECT_TRUE(on_line.triangles().empty());
  expect_right(on_line, {2.0, 2.0});
  expect_right(on_line, {9.0, 2.6});
  const MapTriangulation one(MapPlaces::Zero(3, 2));
  expect_right(one, {0.0, 0.0});
  EXPECT_EQ(one.pick(1.0, 0.0).nearest_distance, 1.0);
  const PickedFrame nothing = MapTriangulation(MapPlaces(0, 2)).pick(0.0, 0.0);
  EXPECT_FALSE(nothing.inside);
  EXPECT_EQ(nothing.nearest, -1);
}

TEST(Triangulation, SurvivesNearlyFlatTriangles) {
  std::mt19937 random(74);
  MapPlaces places = random_places(random, 60);
  places.col(1) *= 1e-13;
  const MapTriangulation map(places);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    const PickedFrame picked = map.pick(share(random), 1e-13 * share(random));
    double sum = 0.0;
    for (const double weight : picked.weights) {
      EXPECT_TRUE(weight >= 0.0 && weight <= 1.0);
      sum += weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(Triangulation, InterpolatedFramesLieBetweenTheirCorners) {
  std::mt19937 random(75);
  const MapTriangulation map(random_places(random, 80));
  const FrameMatrix frames = test::uniform_points(random, 80, 25);
  std::uniform_real_distribution<double> coordinate(-0.1, 1.1);
  for (int i = 0; i < 200; ++i) {
    const PickedFrame picked = map.pick(coordinate(random), coordinate(random));
    const Eigen::VectorXd frame = interpolate_frame(picked, frames);
    FrameMatrixD corners(3, 25);
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      corners.row(corner) =
          frames.row(picked.corners[static_cast<std::size_t>(corner)]).cast<double>();
    }
    EXPECT_TRUE((frame.array() <= corners.colwise().maxCoeff().transpose().array() + 1e-12).all());
    EXPECT_TRUE((frame.array() >= corners.colwise().minCoeff().transpose().array() - 1e-12).all());
    // Back from the frame: the weights, if the corners are three frames.
    if (picked.inside) {
      const Eigen::Vector3d weights = corners.transpose().colPivHouseholderQr().solve(frame);
      for (Eigen::Index corner = 0; corner < 3; ++corner) {
        EXPECT_NEAR(weights[corner], picked.weights[static_cast<std::size_t>(corner)], 1e-9);
      }
    } else {
      EXPECT_EQ(frame, corners.row(0).transpose());
    }
  }
}

TEST(Triangulation, IsPickedByTwoThreadsAtOnce) {
  std::mt19937 random(76);
  const MapTriangulation map(random_places(random, 300));
  const auto pick_all = [&] {
    std::vector<Corners> corners;
    for (int i = 0; i < 2000; ++i) {
      corners.push_back(map.pick((i % 40) / 40.0, (i / 40) / 50.0).corners);
    }
    return corners;
  };
  std::vector<Corners> other;
  std::thread thread([&] { other = pick_all(); });
  const std::vector<Corners> mine = pick_all();
  thread.join();
  EXPECT_EQ(mine, other);
}

TEST(Triangulation, RefusesPlacesThatAreNone) {
  std::mt19937 random(77);
  const MapTriangulation map(random_places(random, 10));
  test::expect_error([&] { map.pick(std::nan(""), 0.0); },
                     "expected two finite numbers, got nan 0");
  MapPlaces places = MapPlaces::Zero(2, 2);
  places(1, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(MapTriangulation{places}, InternalError);
}

} // namespace
} // namespace phonomime
