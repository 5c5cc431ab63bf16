// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/nodes_by_key.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(NodesByKey, AreThoseOfAStableSort) {
  std::mt19937 random(41);
  for (const std::size_t count : {0, 1, 7, 1000}) {
    std::uniform_int_distribution<std::size_t> draw(3, 40);
    std::vector<std::size_t> keys(count);
    std::ranges::generate(keys, [&] { return 2 * draw(random); }); // no odd one occurs
    std::vector<NodeIndex> expected(count);
    std::iota(expected.begin(), expected.end(), 0);
    const auto key = [&](NodeIndex node) { return keys[static_cast<std::size_t>(node)]; };
    std::ranges::stable_sort(expected, {}, key);
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < count; ++i) {
      if (i == 0 || key(expected[i]) != key(expected[i - 1])) {
        begins.push_back(i);
      }
    }
    begins.push_back(count);
    const NodesByKey sorted = nodes_by_key(keys);
    EXPECT_EQ(sorted.nodes, expected);
    EXPECT_EQ(sorted.begins, begins);
  }
}

} // namespace
} // namespace phonomime
