// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/motion_table.h"

#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using test::input_error;

// Sentences of one speaker in two emotions; rows 0 and 3 of each are silence.
MotionTable small_table() {
  MotionTable table;
  table.phonemes = {{"pau", "pau"}, {"aa", "ae"}};
  table.visemes = {"pau", "ae"};
  table.emotions = {"anger", "neutral"};
  table.speaker = "s1";
  table.sentences = {{"s1", "anger", "bbaf2n", ""},
                     {"s1", "anger", "xbbaf2n", ""},
                     {"s1", "neutral", "bbaf2n", ""},
                     {"s1", "neutral", "lone", ""}};
  for (std::int32_t sentence = 0; sentence < 4; ++sentence) {
    for (const std::int32_t order : {1, 2, 4, 10}) {
      MotionNode node;
      node.sentence = sentence;
      node.order = order;
      table.nodes.push_back(node);
    }
  }
  table.unavailable = {{"s1/anger/xbbaf2n#5", "has unfilled gaps"},
                       {"s1/neutral/lone#5", "pruned by ann on 2026-01-02: jump"},
                       {"s1/neutral/pair#1", "pruned by ann on 2026-01-02: jump"},
                       {"s1/anger/pair#1", "pruned by ann on 2026-01-02: jump"},
                       {"s1/anger/lone#2", "pruned by ann on 2026-01-02: jump"}};
  return table;
}

std::string find_error(std::string_view key) {
  const MotionTable table = small_table();
  return input_error([&] { table.find_node(key, "c.txt:3"); });
}

TEST(MotionTable, EveryKeyFindsItsNode) {
  const MotionTable table = small_table();
  EXPECT_EQ(table.key(0), "s1/anger/bbaf2n#1");
  EXPECT_EQ(table.key(15), "s1/neutral/lone#10");
  for (NodeIndex node = 0; node < table.node_count(); ++node) {
    EXPECT_EQ(table.find_node(table.key(node), "x"), node);
  }
}

TEST(MotionTable, ShortFormsWhileTheyAreUnique) {
  const MotionTable table = small_table();
  EXPECT_EQ(table.key(table.find_node("neutral/bbaf2n#4", "x")), "s1/neutral/bbaf2n#4");
  EXPECT_EQ(table.key(table.find_node("lone#10", "x")), "s1/neutral/lone#10");
  EXPECT_EQ(table.key(table.find_node("xbbaf2n#1", "x")), "s1/anger/xbbaf2n#1");
  EXPECT_EQ(
      find_error("bbaf2n#4"),
      "c.txt:3: \"bbaf2n#4\" is ambiguous: 2 motion nodes have that key. Write one of them in "
      "full: s1/anger/bbaf2n#4, s1/neutral/bbaf2n#4");
  EXPECT_NE(find_error("lone#2").find("is ambiguous"), std::string::npos)
      << "a pruned node still has its key";
  EXPECT_NE(find_error("pair#1").find("is ambiguous"), std::string::npos);
}

TEST(MotionTable, UnavailableNodesSayWhy) {
  EXPECT_EQ(find_error("lone#5"),
            "c.txt:3: motion node s1/neutral/lone#5 cannot be used: pruned by "
            "ann on 2026-01-02: jump. Choose another node, or restore it.");
  EXPECT_NE(find_error("xbbaf2n#5").find("has unfilled gaps"), std::string::npos);
  EXPECT_NE(find_error("anger/pair#1").find("s1/anger/pair#1 cannot be used"), std::string::npos);
}

TEST(MotionTable, UnknownKeysNameTheNearest) {
  EXPECT_EQ(find_error("anger/bbaf2n#3"),
            "c.txt:3: there is no motion node \"anger/bbaf2n#3\" of speaker \"s1\". Did you mean "
            "s1/anger/bbaf2n#2 or s1/anger/bbaf2n#4 or s1/anger/bbaf2n#1?");
  EXPECT_NE(find_error("bbaf2n#3").find("Did you mean s1/anger/bbaf2n#2 or s1/neutral/bbaf2n#2?"),
            std::string::npos);
  EXPECT_NE(find_error("lona#1").find("Did you mean s1/neutral/lone#1?"), std::string::npos);
  EXPECT_NE(find_error("angr/bbaf2n#1").find("Did you mean s1/anger/bbaf2n#1"), std::string::npos);
  EXPECT_NE(find_error("s2/anger/bbaf2n#1").find("of speaker \"s1\""), std::string::npos);
  EXPECT_NE(find_error("ger/bbaf2n#1").find("there is no motion node"), std::string::npos);
  EXPECT_NE(find_error("one#5").find("there is no motion node"), std::string::npos);
  EXPECT_NE(find_error("baf2n#1").find("there is no motion node"), std::string::npos)
      << "a part is left out whole";
  for (const char* key : {"", "#1", "bbaf2n", "bbaf2n#", "bbaf2n#x", "bbaf2n#-1", "bbaf2n#1.0",
                          "bbaf2n#99999999999"}) {
    EXPECT_NE(find_error(key).find("is not the key of a motion node"), std::string::npos) << key;
  }
}

TEST(MotionTable, NamesAreFound) {
  const MotionTable table = small_table();
  EXPECT_EQ(table.find_phoneme("aa"), 1);
  EXPECT_EQ(table.find_viseme("ae"), 1);
  EXPECT_EQ(table.find_emotion("neutral"), 1);
  EXPECT_EQ(table.find_phoneme("zz"), std::nullopt);
  EXPECT_EQ(table.find_viseme("zz"), std::nullopt);
  EXPECT_EQ(table.find_emotion("zz"), std::nullopt);
}

} // namespace
} // namespace phonomime
