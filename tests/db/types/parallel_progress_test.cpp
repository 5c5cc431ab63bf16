// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/parallel_progress.h"

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime::test {

TEST(ParallelProgress, TellsEachPieceOnceItIsDone) {
  for (const int threads : {1, 3}) {
    std::vector<std::int64_t> told;
    Progress progress;
    progress.report = [&](std::string_view stage, std::int64_t done, std::int64_t total) {
      EXPECT_EQ(stage, "work");
      EXPECT_EQ(total, 20);
      told.push_back(done);
    };
    std::vector<std::atomic<int>> done(20);
    parallel_for(20, threads, progress, "work",
                 [&](std::ptrdiff_t i) { ++done[static_cast<std::size_t>(i)]; });
    ASSERT_EQ(told.size(), 21U);
    for (std::size_t i = 0; i < told.size(); ++i) {
      EXPECT_EQ(told[i], static_cast<std::int64_t>(i));
    }
    for (const std::atomic<int>& count : done) {
      EXPECT_EQ(count, 1);
    }
  }
}

TEST(ParallelProgress, LeavesOutWhatIsNotBegunWhereItIsToStop) {
  for (const int threads : {1, 3}) {
    std::atomic<bool> stop = false;
    std::atomic<int> begun = 0;
    const Progress progress{.report = {}, .stop = &stop};
    EXPECT_THROW(parallel_for(1000, threads, progress, "work",
                              [&](std::ptrdiff_t) {
                                if (++begun == 5) {
                                  stop = true;
                                }
                              }),
                 Interrupted);
    EXPECT_GE(begun, 5);
    EXPECT_LE(begun, 5 + threads);
  }
}

TEST(ParallelProgress, LetsAFailureThrough) {
  EXPECT_THROW(parallel_for(4, 2, Progress{}, "work",
                            [](std::ptrdiff_t i) {
                              if (i == 2) {
                                throw InputError({.what = "a piece failed"});
                              }
                            }),
               InputError);
}

} // namespace phonomime::test
