// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/concat/stream_shares.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kRate_hz = 100.0;

// Spans of mostly `usual` frames, some far shorter than one; never more than two of these in a row.
std::vector<TimeSpan> random_spans(std::mt19937& random, int count, double usual) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<TimeSpan> spans;
  double end_s = 0.0;
  int shorts = 0;
  for (int i = 0; i < count; ++i) {
    const bool is_short = shorts < 2 && part(random) < 0.3;
    shorts = is_short ? shorts + 1 : 0;
    const double frames = is_short ? 0.9 * part(random) : usual * (0.7 + 0.6 * part(random));
    const double start_s = end_s;
    end_s += frames / kRate_hz;
    spans.push_back({start_s, end_s, part(random) < 0.85});
  }
  return spans;
}

// All shares, taken as soon as they are to be had, with how many spans were there before each.
std::vector<std::pair<FrameRange, std::size_t>> streamed(const std::vector<TimeSpan>& spans) {
  StreamShares shares(kRate_hz);
  std::vector<std::pair<FrameRange, std::size_t>> ranges;
  const auto take = [&](std::size_t known) {
    while (const auto range = shares.take()) {
      ranges.emplace_back(*range, known);
    }
  };
  for (std::size_t i = 0; i < spans.size(); ++i) {
    shares.push(spans[i]);
    take(i + 1);
  }
  shares.finish();
  take(spans.size());
  EXPECT_EQ(shares.pending_count(), 0u);
  return ranges;
}

TEST(StreamShares, AreThoseOfAllSpansAtOnce) {
  std::mt19937 random(41);
  int given = 0;
  for (int round = 0; round < 3000; ++round) {
    const double usual = std::vector<double>{5.0, 7.0, 9.0}[static_cast<std::size_t>(round % 3)];
    const std::vector<TimeSpan> spans = random_spans(random, 1 + round % 40, usual);
    const std::vector<FrameRange> expected = assign_frames(spans, kRate_hz);
    const auto ranges = streamed(spans);
    ASSERT_EQ(ranges.size(), expected.size());
    for (std::size_t i = 0; i < spans.size(); ++i) {
      ASSERT_EQ(ranges[i].first.first, expected[i].first) << round << " " << i;
      ASSERT_EQ(ranges[i].first.count, expected[i].count) << round << " " << i;
      given += expected[i].first != first_frame_at(spans[i].start_s, kRate_hz) ? 1 : 0;
    }
  }
  EXPECT_GT(given, 5000); // frames did change hands
}

TEST(StreamShares, OfOrdinaryPhonemesAreFinalOneRowLater) {
  std::vector<TimeSpan> spans;
  for (int i = 0; i < 30; ++i) {
    spans.push_back({0.07 * i, 0.07 * (i + 1), true});
  }
  const auto ranges = streamed(spans);
  for (std::size_t i = 0; i + 1 < spans.size(); ++i) {
    EXPECT_EQ(ranges[i].second, i + 2);
  }
}

// Where more spans are short than it reaches over, it still gives every frame once and waits for a
// bounded number of rows.
TEST(StreamShares, HoldBackAFewSpansAtMost) {
  std::mt19937 random(42);
  for (int round = 0; round < 2000; ++round) {
    std::vector<TimeSpan> spans = random_spans(random, 60, 1.2);
    const auto ranges = streamed(spans);
    ASSERT_EQ(ranges.size(), spans.size());
    std::int64_t frame = 0;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      ASSERT_EQ(ranges[i].first.first, frame);
      ASSERT_GE(ranges[i].first.count, 0);
      frame = ranges[i].first.end();
      ASSERT_LE(ranges[i].second, i + 1 + 2 * StreamShares::kReach);
    }
    EXPECT_EQ(frame, first_frame_at(spans.back().end_s, kRate_hz));
  }
}

} // namespace
} // namespace phonomime
