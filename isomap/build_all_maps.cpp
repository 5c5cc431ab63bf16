// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/build_all_maps.h"

#include "db/types/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

namespace phonomime {

namespace {

// Frames. The geodesics of a cluster above it keep all threads busy, and matrices of several such
// clusters at once would take too much memory.
constexpr Eigen::Index kLargestSideBySide = 1500;

} // namespace

void build_all_maps(std::span<const PhonemeCluster> clusters, const IsomapOptions& options,
                    const Progress& progress,
                    const std::function<void(std::size_t i, ClusterMaps&& maps)>& take) {
  options.validate();
  std::vector<std::size_t> order(clusters.size()); // the largest first, so that none is left over
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::size_t i) { return clusters[i].frame_count(); });
  const auto first_small = std::ranges::find_if(
      order, [&](std::size_t i) { return clusters[i].frame_count() <= kLargestSideBySide; });

  std::int64_t done = 0, total = 0;
  for (const PhonemeCluster& cluster : clusters) {
    total += cluster.frame_count();
  }
  progress.update("maps", 0, total);
  std::mutex mutex;
  std::atomic<bool> failed = false;
  const auto build = [&](std::size_t i, int threads) {
    if (failed) {
      return;
    }
    try {
      IsomapOptions own = options;
      own.threads = threads;
      ClusterMaps maps = build_maps(clusters[i].frames, own, {.report = {}, .stop = progress.stop});
      const std::scoped_lock lock(mutex);
      take(i, std::move(maps));
      done += clusters[i].frame_count();
      progress.update("maps", done, total);
    } catch (...) {
      failed = true;
      throw;
    }
  };
  std::for_each(order.begin(), first_small, [&](std::size_t i) { build(i, options.threads); });
  parallel_for(order.end() - first_small, options.threads,
               [&](std::ptrdiff_t i) { build(first_small[i], 1); });
}

} // namespace phonomime
