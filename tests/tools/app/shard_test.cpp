// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/shard.h"

#include "db/types/errors.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(Shard, TheShardsOfACountHoldEveryRowOnceAndAboutAsManyEach) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    const std::size_t rows = random() % 200;
    const long count = 1 + static_cast<long>(random() % 40);
    std::vector<int> holders(rows, 0);
    std::vector<std::size_t> sizes;
    for (long number = 1; number <= count; ++number) {
      const Shard shard = parse_shard(format_shard({.number = number, .count = count}));
      EXPECT_EQ(shard.number, number);
      EXPECT_EQ(shard.count, count);
      std::size_t size = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        holders[row] += shard.holds(row) ? 1 : 0;
        size += shard.holds(row) ? 1 : 0;
      }
      sizes.push_back(size);
    }
    EXPECT_TRUE(std::ranges::all_of(holders, [](int holder) { return holder == 1; }))
        << rows << " rows, " << count << " shards";
    EXPECT_LE(std::ranges::max(sizes) - std::ranges::min(sizes), 1u);
  }
}

TEST(Shard, WhatIsNoShardIsAUsageError) {
  for (const char* text : {"", "1", "0/2", "3/2", "-1/2", "1/0", "1/2/3", "a/b", "1.0/2", "1/ 2",
                           "1/99999999999999999999"}) {
    EXPECT_THROW(parse_shard(text), UsageError) << text;
  }
}

} // namespace
} // namespace phonomime
