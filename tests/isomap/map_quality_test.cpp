// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "isomap/map_quality.h"
#include "tests/isomap/point_sets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

std::vector<std::int32_t> one_each(Eigen::Index count) {
  std::vector<std::int32_t> groups(static_cast<std::size_t>(count));
  std::iota(groups.begin(), groups.end(), 0);
  return groups;
}

// Place of every other point in the order of distance from point i, counted from 1; 0 for i itself.
template <typename Rows>
std::vector<int> ranks(const Rows& rows, Eigen::Index i) {
  std::vector<std::pair<double, Eigen::Index>> order;
  for (Eigen::Index j = 0; j < rows.rows(); ++j) {
    if (j != i) {
      order.emplace_back((rows.row(i) - rows.row(j)).template cast<double>().squaredNorm(), j);
    }
  }
  std::sort(order.begin(), order.end());
  std::vector<int> rank(static_cast<std::size_t>(rows.rows()), 0);
  for (std::size_t r = 0; r < order.size(); ++r) {
    rank[static_cast<std::size_t>(order[r].second)] = static_cast<int>(r) + 1;
  }
  return rank;
}

// Venna and Kaski's formula over all pairs.
template <typename True, typename Shown>
double trust(const True& points, const Shown& shown, int k) {
  const Eigen::Index n = points.rows();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<int> true_rank = ranks(points, i), shown_rank = ranks(shown, i);
    for (std::size_t j = 0; j < true_rank.size(); ++j) {
      if (shown_rank[j] >= 1 && shown_rank[j] <= k && true_rank[j] > k) {
        sum += true_rank[j] - k;
      }
    }
  }
  const double nd = static_cast<double>(n);
  return 1.0 - 2.0 / (nd * k * (2.0 * nd - 3.0 * k - 1.0)) * sum;
}

TEST(MapQuality, TrustworthinessAndContinuityEqualTheirDefinition) {
  std::mt19937 random(61);
  const FrameMatrix points = test::uniform_points(random, 150, 10);
  const MapPlaces places = points.leftCols(2).cast<double>();
  const FrameMatrixD exact = points.cast<double>();
  const std::vector<std::int32_t> labels(150, 0), groups = one_each(150);
  for (const int k : {1, 5, 12}) {
    const MapQuality quality = measure_map(points, places, labels, groups, {.neighbours = k});
    EXPECT_NEAR(quality.trustworthiness.value(), trust(exact, places, k), 1e-12);
    EXPECT_NEAR(quality.continuity.value(), trust(places, exact, k), 1e-12);
    EXPECT_LT(*quality.trustworthiness, 0.95);
  }
}

TEST(MapQuality, OfTheSamePlacesIsPerfect) {
  std::mt19937 random(62);
  const FrameMatrix points = test::uniform_points(random, 100, 2);
  const std::vector<std::int32_t> labels(100, 0);
  const MapQuality quality = measure_map(points, points.cast<double>(), labels, one_each(100));
  EXPECT_EQ(quality.trustworthiness, 1.0);
  EXPECT_EQ(quality.continuity, 1.0);
  EXPECT_FALSE(quality.purity || quality.silhouette) << "one label alone";
}

TEST(MapQuality, SilhouetteAndPurityOfSmallSetsByHand) {
  // On a line: a a b b at 0 1 10 12.
  MapPlaces places = MapPlaces::Zero(4, 2);
  places.col(0) << 0.0, 1.0, 10.0, 12.0;
  const std::vector<std::int32_t> labels = {7, 7, 3, 3};
  const MapQuality quality =
      measure_map(places.cast<float>(), places, labels, one_each(4), {.neighbours = 1});
  // (b - a) / max: (11 - 1) / 11, (10 - 1) / 10, (9.5 - 2) / 9.5, (11.5 - 2) / 11.5
  EXPECT_NEAR(quality.silhouette.value(), (10.0 / 11.0 + 9.0 / 10.0 + 7.5 / 9.5 + 9.5 / 11.5) / 4.0,
              1e-12);
  EXPECT_EQ(quality.purity, 1.0);
  EXPECT_NEAR(quality.purity_by_lot.value(), 1.0 / 3.0, 1e-12);
  // With two neighbours one of them is of the other kind.
  EXPECT_EQ(
      measure_map(places.cast<float>(), places, labels, one_each(4), {.neighbours = 2}).purity,
      0.5);
}

TEST(MapQuality, NeighboursOfTheSameNodeDoNotCount) {
  MapPlaces places = MapPlaces::Zero(4, 2);
  places.col(0) << 0.0, 1.0, 10.0, 12.0;
  const std::vector<std::int32_t> labels = {0, 0, 1, 1}, nodes = {0, 0, 1, 1};
  const MapQuality quality =
      measure_map(places.cast<float>(), places, labels, nodes, {.neighbours = 1});
  EXPECT_EQ(quality.purity, 0.0);
  EXPECT_EQ(quality.purity_by_lot, 0.0);
}

TEST(MapQuality, OfLabelsByLotIsThatOfLots) {
  std::mt19937 random(63);
  const FrameMatrix points = test::uniform_points(random, 3000, 2);
  std::uniform_int_distribution<std::int32_t> label(0, 3);
  std::vector<std::int32_t> labels(3000);
  std::generate(labels.begin(), labels.end(), [&] { return label(random); });
  const MapQuality quality = measure_map(points, points.cast<double>(), labels, one_each(3000));
  EXPECT_NEAR(*quality.purity, 0.25, 0.01);
  EXPECT_NEAR(*quality.purity_by_lot, 0.25, 0.01);
  EXPECT_NEAR(*quality.silhouette, 0.0, 0.02);
}

TEST(MapQuality, HasNoMeaningForAFew) {
  const std::vector<std::int32_t> none, one = {0};
  const MapQuality empty = measure_map(FrameMatrix(0, 3), MapPlaces(0, 2), none, none);
  EXPECT_FALSE(empty.purity || empty.silhouette || empty.trustworthiness || empty.continuity);
  const MapQuality single = measure_map(FrameMatrix::Zero(1, 3), MapPlaces::Zero(1, 2), one, one);
  EXPECT_FALSE(single.purity || single.silhouette || single.trustworthiness || single.continuity);
  EXPECT_THROW(measure_map(FrameMatrix::Zero(2, 3), MapPlaces::Zero(1, 2), one, one),
               InternalError);
}

TEST(MapQuality, OfASampleComesNearThatOfAll) {
  std::mt19937 random(64);
  const FrameMatrix points = test::trajectory_points(random, 200, 10, 25);
  const MapPlaces places = pca_places(points);
  std::vector<std::int32_t> labels(2000);
  for (std::size_t i = 0; i < 2000; ++i) {
    labels[i] = places(static_cast<Eigen::Index>(i), 0) > 0.0;
  }
  const MapQuality all = measure_map(points, places, labels, one_each(2000), {.threads = 1});
  const MapQuality again = measure_map(points, places, labels, one_each(2000), {.threads = 2});
  const MapQuality some =
      measure_map(points, places, labels, one_each(2000), {.largest_sample = 700});
  EXPECT_EQ(all.trustworthiness, again.trustworthiness);
  EXPECT_EQ(all.silhouette, again.silhouette);
  EXPECT_NEAR(*some.silhouette, *all.silhouette, 0.05);
  EXPECT_NEAR(*some.purity, *all.purity, 0.05);
  EXPECT_NEAR(*some.trustworthiness, *all.trustworthiness, 0.05);
}

} // namespace
} // namespace phonomime
