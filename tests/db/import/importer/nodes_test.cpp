// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/nodes.h"

#include "db/types/errors.h"

#include <gtest/gtest.h>

#include <random>

namespace phonomime {
namespace {

TimedPhoneme row(const char* name, double start_s, double end_s) {
  return {.phoneme = {.name = name, .viseme = name}, .start_s = start_s, .end_s = end_s};
}

TEST(Nodes, EveryFrameOutsideSilenceIsInExactlyOneNodeAndNoNodeIsEmpty) {
  std::mt19937 random(1);
  std::exponential_distribution<double> duration(1.0 / 0.03);
  for (int round = 0; round < 500; ++round) {
    const double rate_hz = round % 2 == 0 ? 25.0 : 100.0;
    std::vector<TimedPhoneme> rows{row("pau", 0.0, 0.5)};
    for (int i = 0; i < 30; ++i) {
      const double start_s = rows.back().end_s;
      rows.push_back(row(i % 7 == 6 ? "pau" : "ah", start_s, start_s + 1e-4 + duration(random)));
    }
    rows.push_back(row("pau", rows.back().end_s, rows.back().end_s + 0.5));
    const std::vector<ImportedNode> nodes = cut_into_nodes(rows, rate_hz, "test");
    std::size_t node = 0;
    std::int32_t last = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].is_silence()) {
        continue;
      }
      ASSERT_LT(node, nodes.size());
      EXPECT_EQ(nodes[node].row, static_cast<std::int32_t>(i));
      EXPECT_GE(nodes[node].frame_count, 1);
      EXPECT_GE(nodes[node].first_frame, last);
      if (i > 0 && !rows[i - 1].is_silence()) {
        EXPECT_EQ(nodes[node].first_frame, last); // no frame between neighbours is lost
      }
      last = nodes[node].first_frame + nodes[node].frame_count;
      ++node;
    }
    EXPECT_EQ(node, nodes.size());
  }
}

TEST(Nodes, MorePhonemesThanFramesIsAnError) {
  std::vector<TimedPhoneme> rows;
  for (int i = 0; i < 20; ++i) {
    rows.push_back(row("t", 0.01 * i, 0.01 * (i + 1)));
  }
  try {
    cut_into_nodes(rows, 25.0, "s.tsv:3");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.details().where, "s.tsv:3");
    EXPECT_EQ(error.details().got, "20 phonemes in 5 frames at 25 Hz");
  }
}

} // namespace
} // namespace phonomime
