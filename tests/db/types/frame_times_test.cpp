// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/frame_times.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(FrameTimes, FindsFramesAsExactArithmeticDoes) {
  for (const int thousandths : {24000, 25000, 29970, 30000, 50000, 60000, 100000, 120000}) {
    const double rate = thousandths / 1000.0;
    for (std::int64_t time = 0; time < 900000; time += 7) { // in units of 10 microseconds
      const double time_s = static_cast<double>(time) / 1e5;
      const std::int64_t whole = time * thousandths / 100000000;
      const bool on_a_frame = time * thousandths % 100000000 == 0;
      ASSERT_EQ(first_frame_at(time_s, rate), on_a_frame ? whole : whole + 1)
          << time_s << " " << rate;
      ASSERT_EQ(frame_count_to(time_s, rate), whole + 1) << time_s << " " << rate;
    }
  }
  EXPECT_EQ(first_frame_at(0.07, 100.0), 7);  // 0.07 * 100 > 7
  EXPECT_EQ(frame_count_to(0.29, 100.0), 30); // 0.29 * 100 < 29
  EXPECT_EQ(frame_count_to(-0.5, 100.0), 0);
}

std::vector<std::int64_t> counts(const std::vector<TimeSpan>& spans) {
  std::vector<std::int64_t> result;
  for (const FrameRange& range : assign_frames(spans, 100.0)) {
    result.push_back(range.count);
  }
  return result;
}

using Counts = std::vector<std::int64_t>;

TEST(AssignFrames, GivesAFrameToTheSpanThatHoldsItsTime) {
  EXPECT_EQ(counts({{0.0, 0.05}, {0.05, 0.0701}, {0.0701, 0.1}}), (Counts{5, 3, 2}));
  EXPECT_EQ(counts({}), Counts{});
}

TEST(AssignFrames, TakesFromTheLongerNeighbour) {
  EXPECT_EQ(counts({{0.0, 0.051}, {0.051, 0.059}, {0.059, 0.2}}), (Counts{6, 1, 13}));
  EXPECT_EQ(counts({{0.0, 0.201}, {0.201, 0.209}, {0.209, 0.25}}), (Counts{20, 1, 4}));
  EXPECT_EQ(counts({{0.0, 0.101}, {0.101, 0.109}, {0.109, 0.21}}), (Counts{10, 1, 10}));
}

TEST(AssignFrames, TakesFromTheNearestRatherThanTheLongest) {
  EXPECT_EQ(counts({{0.0, 0.021}, {0.021, 0.029}, {0.029, 0.039}, {0.039, 0.1}}),
            (Counts{2, 1, 1, 6}));
  EXPECT_EQ(counts({{0.0, 0.061}, {0.061, 0.071}, {0.071, 0.079}, {0.079, 0.1}}),
            (Counts{7, 1, 1, 1}));
}

TEST(AssignFrames, LeavesSilenceWithoutAFrameOrTakesItsLast) {
  EXPECT_EQ(counts({{0.0, 0.051}, {0.051, 0.059, false}, {0.059, 0.2}}), (Counts{6, 0, 14}));
  EXPECT_EQ(counts({{0.0, 0.001}, {0.001, 0.009}, {0.009, 0.019, false}}), (Counts{1, 1, 0}));
  EXPECT_EQ(counts({{0.0, 0.001}, {0.001, 0.009}, {0.009, 0.011, false}, {0.011, 0.021}}),
            (Counts{1, 1, 0, 1}));
}

TEST(AssignFrames, PassesAFrameOnWhereNoNeighbourHasOneToSpare) {
  EXPECT_EQ(counts({{0.0, 0.041}, {0.041, 0.044}, {0.044, 0.047}, {0.047, 0.051}}),
            (Counts{3, 1, 1, 1}));
  EXPECT_EQ(counts({{0.0, 0.003}, {0.003, 0.006}, {0.006, 0.009}, {0.009, 0.04}}),
            (Counts{1, 1, 1, 1}));
  EXPECT_EQ(counts({{0.0, 0.003}, {0.003, 0.006}, {0.006, 0.009}}), (Counts{1, 0, 0}));
}

// Whatever the spans: ranges follow each other from the first time to the last, everybody who needs
// a frame has one as long as there are enough, and a span no frame passed through keeps its own.
TEST(AssignFrames, SharesOutEveryFrameOnce) {
  std::mt19937 random(31);
  std::exponential_distribution<double> duration;
  std::uniform_int_distribution<int> dice(0, 5);
  for (int round = 0; round < 3000; ++round) {
    std::vector<TimeSpan> spans;
    double t = round % 2 == 0 ? 0.0 : 0.1234;
    const double mean_s = 0.005 * (1 + round % 10);
    std::int64_t needy = 0;
    for (int i = 0; i < 25; ++i) {
      const double next = t + duration(random) * mean_s;
      spans.push_back({t, next, dice(random) != 0});
      needy += spans.back().needs_frame ? 1 : 0;
      t = next;
    }
    const std::vector<FrameRange> ranges = assign_frames(spans, 100.0);
    ASSERT_EQ(ranges.size(), spans.size());
    std::int64_t at = first_frame_at(spans.front().start_s, 100.0);
    const std::int64_t total = first_frame_at(spans.back().end_s, 100.0) - at;
    std::int64_t served = 0;
    bool untouched = true;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      ASSERT_EQ(ranges[i].first, at);
      ASSERT_GE(ranges[i].count, 0);
      at = ranges[i].end();
      served += spans[i].needs_frame && ranges[i].count > 0 ? 1 : 0;
      const std::int64_t own =
          first_frame_at(spans[i].end_s, 100.0) - first_frame_at(spans[i].start_s, 100.0);
      untouched = untouched && (own > 0 || !spans[i].needs_frame);
    }
    EXPECT_EQ(at, first_frame_at(spans.back().end_s, 100.0));
    EXPECT_EQ(served, std::min(needy, total));
    for (std::size_t i = 0; untouched && i < spans.size(); ++i) {
      EXPECT_EQ(ranges[i].first, first_frame_at(spans[i].start_s, 100.0));
    }
  }
}

} // namespace
} // namespace phonomime
