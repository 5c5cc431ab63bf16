// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/table_part.h"

#include "tests/tools/evaluate/small_table.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace phonomime {
namespace {

TEST(TablePart, KeepsNodesFramesAndLinksOfItsSentences) {
  test::Draw draw(9);
  const MotionTable table = test::contextual_table(draw, 20);
  std::vector<bool> keep;
  for (std::size_t s = 0; s < table.sentences.size(); ++s) {
    keep.push_back(s == 3 || draw.chance(0.4));
  }
  const MotionTable part = part_of(table, keep);
  std::map<std::string, NodeIndex> known;
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    known[table.key(node)] = node;
  }
  NodeIndex kept = 0;
  for (const MotionNode& node : table.nodes) {
    kept += keep[static_cast<std::size_t>(node.sentence)] ? 1 : 0;
  }
  EXPECT_EQ(part.node_count(), kept);
  const auto key_or_none = [](const MotionTable& from, NodeIndex node) {
    return node == kNoNode ? std::string("none") : from.key(node);
  };
  for (NodeIndex node = 0; node < part.node_count(); ++node) {
    const NodeIndex before = known.at(part.key(node));
    const MotionNode& ours = part.nodes[static_cast<std::size_t>(node)];
    const MotionNode& theirs = table.nodes[static_cast<std::size_t>(before)];
    EXPECT_EQ(part.node_frames(node), table.node_frames(before));
    EXPECT_EQ(ours.phoneme, theirs.phoneme);
    EXPECT_EQ(key_or_none(part, ours.predecessor), key_or_none(table, theirs.predecessor));
    EXPECT_EQ(key_or_none(part, ours.successor), key_or_none(table, theirs.successor));
  }
}

TEST(TablePart, AllOfATableIsTheTable) {
  test::Draw draw(10);
  const MotionTable table = test::contextual_table(draw, 8);
  const MotionTable part = part_of(table, std::vector<bool>(table.sentences.size(), true));
  EXPECT_EQ(part.coefficients, table.coefficients);
  EXPECT_EQ(part.node_count(), table.node_count());
}

TEST(ContextCoverage, CountsPairsAndTriplesThatWereRecorded) {
  MotionTable table;
  table.phonemes = {{"pau", "pau"}, {"b", "b"}, {"aa", "aa"}, {"t", "t"}};
  const auto node = [](std::int32_t before, std::int32_t phoneme, std::int32_t after) {
    MotionNode made;
    made.previous_phoneme = before;
    made.phoneme = phoneme;
    made.next_phoneme = after;
    return made;
  };
  table.nodes = {node(0, 1, 2), node(1, 2, 0)}; // b aa
  ImportedSentence asked;
  const auto say = [&](std::initializer_list<std::size_t> phonemes) {
    asked.rows.clear();
    for (const std::size_t phoneme : phonemes) {
      asked.rows.push_back({.phoneme = table.phonemes[phoneme]});
    }
    return context_coverage(table, std::span(&asked, 1));
  };
  ContextCoverage same = say({0, 1, 2, 0});
  EXPECT_EQ(same.diphones, 3);
  EXPECT_EQ(same.diphones_recorded, 3);
  EXPECT_EQ(same.triphones, 2);
  EXPECT_EQ(same.triphones_recorded, 2);
  const ContextCoverage other = say({1, 2, 3}); // without silence at its ends
  EXPECT_EQ(other.diphones, 4);
  EXPECT_EQ(other.diphones_recorded, 2);
  EXPECT_EQ(other.triphones, 3);
  EXPECT_EQ(other.triphones_recorded, 1);
  same.add(other);
  EXPECT_EQ(same.diphones, 7);
  EXPECT_EQ(same.triphones_recorded, 3);
}

} // namespace
} // namespace phonomime
