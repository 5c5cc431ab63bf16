// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/workers.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(Workers, DoEachThingOnceWithOneWorkerAtATimeOfEachNumber) {
  for (const std::size_t workers : {1u, 2u, 5u}) {
    for (const std::size_t count : {0u, 1u, 2u, 100u}) {
      std::vector<std::atomic<int>> done(count);
      std::vector<std::atomic<int>> busy(workers);
      std::atomic<bool> fits = true;
      share_out(count, workers, nullptr, [&](std::size_t worker, std::size_t i) {
        fits = fits && worker < workers && busy[worker].fetch_add(1) == 0;
        ++done[i];
        --busy[worker];
      });
      EXPECT_TRUE(fits);
      for (const std::atomic<int>& times : done) {
        EXPECT_EQ(times, 1);
      }
    }
  }
}

TEST(Workers, WorkAtTheSameTime) {
  std::atomic<int> arrived = 0;
  share_out(2, 2, nullptr, [&](std::size_t, std::size_t) {
    ++arrived;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (arrived < 2 && std::chrono::steady_clock::now() < end) {
      std::this_thread::yield();
    }
    EXPECT_EQ(arrived, 2);
  });
}

TEST(Workers, BeginNothingAfterAStop) {
  std::atomic<bool> stop = false;
  std::mutex mutex;
  std::set<std::size_t> begun;
  share_out(1000, 2, &stop, [&](std::size_t, std::size_t i) {
    const std::scoped_lock lock(mutex);
    begun.insert(i);
    stop = stop || i == 3;
  });
  EXPECT_TRUE(begun.contains(3));
  EXPECT_LE(begun.size(), 6u) << "3 before it, and what was at work beside it";
}

} // namespace
} // namespace phonomime
