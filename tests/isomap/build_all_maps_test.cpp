// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/build_all_maps.h"
#include "tests/isomap/point_sets.h"

#include <atomic>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Clusters of these many frames.
std::vector<PhonemeCluster> clusters_of(const std::vector<int>& sizes) {
  std::mt19937 random(7);
  std::vector<PhonemeCluster> clusters;
  for (const int size : sizes) {
    PhonemeCluster& cluster = clusters.emplace_back();
    cluster.frames = test::trajectory_points(random, size, 1, 6);
  }
  return clusters;
}

void expect_same(const ClusterMaps& a, const ClusterMaps& b) {
  EXPECT_EQ(a.kept, b.kept);
  EXPECT_EQ(a.isomap, b.isomap);
  EXPECT_EQ(a.pca, b.pca);
  EXPECT_EQ(a.isomap_residual_variance, b.isomap_residual_variance);
  EXPECT_EQ(a.pca_residual_variance, b.pca_residual_variance);
  EXPECT_EQ(a.landmarks, b.landmarks);
  EXPECT_EQ(a.component_sizes, b.component_sizes);
}

// Sizes on both sides of what is made side by side, small ones that are all there is, and none.
const std::vector<int> kSizes = {40, 1600, 1, 0, 300, 13, 2, 90, 200, 60, 25, 1501};

TEST(BuildAllMaps, EachClusterGetsItsOwnMaps) {
  const std::vector<PhonemeCluster> clusters = clusters_of(kSizes);
  for (const int threads : {1, 4}) {
    SCOPED_TRACE(threads);
    const IsomapOptions options = {.largest_exact = 1000, .landmarks = 30, .threads = threads};
    std::vector<ClusterMaps> made(clusters.size());
    std::vector<int> times(clusters.size(), 0);
    std::int64_t frames = -1, last = -1;
    const Progress progress = {.report =
                                   [&](std::string_view, std::int64_t done, std::int64_t total) {
                                     EXPECT_GT(done, last);
                                     last = done;
                                     frames = total;
                                   },
                               .stop = nullptr};
    build_all_maps(clusters, options, {}, [&](std::size_t i, ClusterMaps&& maps) {
      made[i] = std::move(maps);
      ++times[i];
    });
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      SCOPED_TRACE(i);
      EXPECT_EQ(times[i], 1);
      expect_same(made[i], build_maps(clusters[i].frames, options));
    }
    const std::vector<PhonemeCluster> sounding = clusters_of({40, 30, 20});
    build_all_maps(sounding, options, progress, [](std::size_t, ClusterMaps&&) {});
    EXPECT_EQ(frames, 90);
    EXPECT_EQ(last, 90);
  }
}

TEST(BuildAllMaps, NoClusters) {
  build_all_maps({}, {}, {}, [](std::size_t, ClusterMaps&&) { FAIL(); });
}

// What was made until then has been taken.
TEST(BuildAllMaps, AStopEndsIt) {
  const std::vector<PhonemeCluster> clusters = clusters_of(kSizes);
  for (const int threads : {1, 3}) {
    std::atomic<bool> stop = false;
    std::set<std::size_t> taken;
    const auto take = [&](std::size_t i, ClusterMaps&& maps) {
      EXPECT_EQ(maps.isomap.rows(), clusters[i].frame_count());
      taken.insert(i);
      stop = stop || taken.size() == 3;
    };
    const Progress progress = {.report = {}, .stop = &stop};
    EXPECT_THROW(build_all_maps(clusters, {.threads = threads}, progress, take), Interrupted);
    EXPECT_GE(taken.size(), 3u);
    EXPECT_LT(taken.size(), 3u + static_cast<std::size_t>(threads)); // those at work
  }
}

TEST(BuildAllMaps, WhatTakeThrowsIsThrown) {
  const std::vector<PhonemeCluster> clusters = clusters_of(kSizes);
  for (const int threads : {1, 3}) {
    int taken = 0;
    const auto take = [&](std::size_t, ClusterMaps&&) {
      if (++taken == 4) {
        throw std::runtime_error("no room");
      }
    };
    EXPECT_THROW(build_all_maps(clusters, {.threads = threads}, {}, take), std::runtime_error);
    EXPECT_LT(taken, 8); // those at work are done, no other begins
  }
}

} // namespace
} // namespace phonomime
