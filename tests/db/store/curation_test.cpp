// SPDX-License-Identifier: GPL-3.0-or-later
// Prune, restore, undo, and the journal of them.
#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

using Keys = std::vector<std::string>;

struct CurationTest : ::testing::Test {
  test::TemporaryFolder folder;
  std::filesystem::path path = folder / "motion.db";
  test::MadeCorpus corpus = test::made_corpus("a", 4);

  CurationTest() {
    setenv("SOURCE_DATE_EPOCH", "1767312000", 1); // 2026-01-02
    corpus.sentences[0].nodes[4].has_gap = true;
    corpus.sentences.push_back(test::made_sentence("s2", "neutral", "a0", 77));
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, corpus);
  }
  ~CurationTest() override { unsetenv("SOURCE_DATE_EPOCH"); }

  CurationOutcome act(CurationAction action, Keys keys, const std::string& reason = "why",
                      bool dry_run = false) {
    return MotionDatabase::open(path, OpenMode::read_write)
        .curate({.action = action,
                 .keys = std::move(keys),
                 .by = "ann",
                 .reason = reason,
                 .dry_run = dry_run});
  }
  CurationOutcome prune(Keys keys) { return act(CurationAction::prune, std::move(keys)); }
  CurationOutcome restore(Keys keys) { return act(CurationAction::restore, std::move(keys)); }
  CurationOutcome undo() { return act(CurationAction::undo, {}, ""); }
  MotionTable table(const std::string& speaker = "s1") const {
    return MotionDatabase::open(path, OpenMode::read_only).load_motion_table(speaker);
  }
  std::vector<JournalEntry> journal() const {
    return MotionDatabase::open(path, OpenMode::read_only).journal();
  }
  Keys pruned() const {
    Keys keys;
    for (const NodeRecord& node :
         MotionDatabase::open(path, OpenMode::read_only).list_nodes({.pruned = true})) {
      keys.push_back(node.key);
    }
    return keys;
  }
};

TEST_F(CurationTest, APrunedNodeIsGoneWithTheLinksAcrossIt) {
  const MotionTable before = table();
  const NodeIndex node = before.find_node("s1/neutral/a2#3", "");
  const MotionNode& pruned_node = before.nodes[static_cast<std::size_t>(node)];
  ASSERT_NE(pruned_node.predecessor, kNoNode);
  ASSERT_NE(pruned_node.successor, kNoNode);
  const std::string earlier = before.key(pruned_node.predecessor);
  const std::string later = before.key(pruned_node.successor);

  const CurationOutcome outcome = prune({"s1/neutral/a2#3"});
  ASSERT_TRUE(outcome.entry);
  EXPECT_EQ(outcome.entry->keys, Keys{"s1/neutral/a2#3"});
  const MotionTable after = table();
  EXPECT_EQ(after.node_count(), before.node_count() - 1);
  const auto at = [&](const std::string& key) {
    return after.nodes[static_cast<std::size_t>(after.find_node(key, ""))];
  };
  EXPECT_EQ(at(earlier).successor, kNoNode);
  EXPECT_EQ(at(later).predecessor, kNoNode);
  test::expect_error([&] { after.find_node("s1/neutral/a2#3", "x"); },
                     "cannot be used: pruned by ann on 2026-01-02: why");

  restore({"s1/neutral/a2#3"});
  const MotionTable again = table();
  EXPECT_EQ(again.node_count(), before.node_count());
  EXPECT_EQ(again.nodes[static_cast<std::size_t>(node)].predecessor, pruned_node.predecessor);
}

TEST_F(CurationTest, TheJournalKeepsWhoWhenAndWhy) {
  prune({"s1/neutral/a2#3", "s1/neutral/a0#1", "s1/happiness/a1#2"});
  act(CurationAction::restore, {"s1/neutral/a0#1"}, "fine");
  undo();
  const std::vector<JournalEntry> entries = journal();
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].id, 1);
  EXPECT_EQ(entries[0].action, CurationAction::prune);
  EXPECT_EQ(entries[0].by, "ann");
  EXPECT_EQ(entries[0].at, "2026-01-02T00:00:00Z");
  EXPECT_EQ(entries[0].reason, "why");
  EXPECT_EQ(entries[0].keys,
            (Keys{"s1/happiness/a1#2", "s1/neutral/a0#1", "s1/neutral/a2#3"})); // in order
  EXPECT_FALSE(entries[0].undone);
  EXPECT_EQ(entries[1].reason, "fine");
  EXPECT_TRUE(entries[1].undone);
  EXPECT_EQ(entries[2].action, CurationAction::undo);
  EXPECT_EQ(entries[2].undoes, 2);
  EXPECT_EQ(entries[2].keys, Keys{"s1/neutral/a0#1"});
}

TEST_F(CurationTest, UndoTakesBackTheLastAndThenTheOneBefore) {
  prune({"a2#3", "s1/neutral/a0#1"});
  prune({"a2#4"});
  restore({"s1/neutral/a0#1"});
  const auto reason_of = [&](const std::string& key) {
    for (const UnavailableNode& node : table().unavailable) {
      if (node.key == key) {
        return node.reason;
      }
    }
    return std::string();
  };
  EXPECT_EQ(pruned(), (Keys{"s1/neutral/a2#3", "s1/neutral/a2#4"}));
  setenv("SOURCE_DATE_EPOCH", "1769990400", 1); // a month later
  undo();
  EXPECT_EQ(pruned(), (Keys{"s1/neutral/a0#1", "s1/neutral/a2#3", "s1/neutral/a2#4"}));
  // Pruned as it was before, not anew.
  EXPECT_EQ(reason_of("s1/neutral/a0#1"), "pruned by ann on 2026-01-02: why");
  undo();
  EXPECT_EQ(pruned(), (Keys{"s1/neutral/a0#1", "s1/neutral/a2#3"}));
  undo();
  EXPECT_TRUE(pruned().empty());
  test::expect_error([&] { undo(); }, "there is nothing to undo");
  // After an undo one goes on as before.
  prune({"a2#5"});
  undo();
  EXPECT_TRUE(pruned().empty());
  EXPECT_EQ(journal().size(), 8u);
  test::expect_sound(path);
}

// Against a list of states that are kept by hand.
TEST_F(CurationTest, AnyNumberOfActsIsTakenBackInTheirOrder) {
  Keys all;
  for (const NodeRecord& node : MotionDatabase::open(path, OpenMode::read_only).list_nodes({})) {
    all.push_back(node.key);
  }
  std::mt19937 random(11);
  std::vector<std::set<std::string>> states{{}};
  for (int round = 0; round < 60; ++round) {
    std::set<std::string> state = states.back();
    if (random() % 3 == 0 && states.size() > 1) {
      undo();
      states.pop_back();
      state = states.back();
    } else {
      const bool prunes = random() % 2 == 0;
      Keys some;
      for (std::uint32_t i = 0; i < 1 + random() % 6; ++i) {
        some.push_back(all[random() % all.size()]);
      }
      const CurationOutcome outcome = prunes ? prune(some) : restore(some);
      const std::size_t before = state.size();
      for (const std::string& key : some) {
        if (prunes) {
          state.insert(key);
        } else {
          state.erase(key);
        }
      }
      EXPECT_EQ(outcome.entry.has_value(), state.size() != before);
      if (outcome.entry) { // else nothing to take back
        states.push_back(state);
      }
    }
    ASSERT_EQ(pruned(), Keys(state.begin(), state.end())) << "round " << round;
  }
}

TEST_F(CurationTest, WhatIsAsAskedForIsLeftAlone) {
  prune({"a2#3"});
  const auto before = test::raw_dump(path);
  const CurationOutcome outcome = prune({"a2#3", "s1/neutral/a2#3"});
  EXPECT_FALSE(outcome.entry);
  EXPECT_EQ(outcome.unchanged, Keys{"s1/neutral/a2#3"});
  EXPECT_EQ(test::raw_dump(path), before);
  const CurationOutcome some = prune({"a2#3", "a2#4", "a2#4"});
  EXPECT_EQ(some.entry->keys, Keys{"s1/neutral/a2#4"});
}

TEST_F(CurationTest, ADryRunTellsTheSameAndChangesNothing) {
  const auto before = test::raw_dump(path);
  const CurationOutcome dry = act(CurationAction::prune, {"a2#3", "a2#4"}, "why", true);
  EXPECT_EQ(test::raw_dump(path), before);
  const CurationOutcome wet = prune({"a2#3", "a2#4"});
  EXPECT_EQ(dry.entry->keys, wet.entry->keys);
  EXPECT_EQ(dry.entry->id, 0);
  EXPECT_EQ(dry.after.triphones, wet.after.triphones);
  EXPECT_EQ(dry.after.nodes, dry.before.nodes - 2);
  const auto pruned_dump = test::raw_dump(path);
  EXPECT_EQ(act(CurationAction::undo, {}, "", true).after.nodes, dry.before.nodes);
  EXPECT_EQ(test::raw_dump(path), pruned_dump);
}

// Counted from the nodes, one by one.
TEST_F(CurationTest, CoverageCountsTheNodesInUse) {
  const CurationOutcome outcome = prune({"a2#3", "s2/neutral/a0#2"});
  Coverage expected;
  for (const NodeRecord& node : MotionDatabase::open(path, OpenMode::read_only).list_nodes({})) {
    const std::int64_t one = node.pruned || node.has_gap ? 0 : 1;
    expected.nodes += one;
    expected.phonemes[{node.speaker, node.phoneme}] += one;
    expected.emotions[{node.speaker, node.phoneme + " " + node.emotion}] += one;
    expected.triphones[{node.speaker, node.previous_phoneme + "-" + node.phoneme + "-" +
                                          node.next_phoneme}] += one;
  }
  EXPECT_EQ(outcome.after.nodes, expected.nodes);
  EXPECT_EQ(outcome.after.phonemes, expected.phonemes);
  EXPECT_EQ(outcome.after.emotions, expected.emotions);
  EXPECT_EQ(outcome.after.triphones, expected.triphones);
  EXPECT_EQ(outcome.before.nodes, expected.nodes + 2);
}

TEST_F(CurationTest, KeysThatNameNoNodeOrSeveralAreRefusedAndNothingIsDone) {
  const auto before = test::raw_dump(path);
  const auto refused = [&](const std::string& key, const std::string& message) {
    test::expect_error([&] { prune({"a2#3", key}); }, message);
    EXPECT_EQ(test::raw_dump(path), before) << key;
  };
  refused("a2", "\"a2\" is not the key of a motion node");
  refused("a2#x", "is not the key");
  refused("#3", "is not the key");
  refused("a2#-1", "is not the key");
  refused("a2#99999999999", "is not the key");
  refused("", "is not the key");
  refused("a2#0", "there is no motion node \"a2#0\""); // silence
  refused("a2#99", "Did you mean s1/neutral/a2#");
  refused("a9#3", "there is no motion node \"a9#3\". Did you mean");
  refused("2#3", "there is no motion node \"2#3\""); // ends within a part
  refused("neutral/a0#1", "is ambiguous: 2 motion nodes have that key. Write one of them in full: "
                          "s1/neutral/a0#1, s2/neutral/a0#1");
  refused(std::string("a2#3\0#4", 7), "no motion node");
  refused("'; DROP TABLE nodes; --#1", "there is no motion node");
}

TEST_F(CurationTest, AShortKeyStaysAmbiguousWhenOneOfItsNodesIsPruned) {
  prune({"s2/neutral/a0#1"});
  test::expect_error([&] { prune({"neutral/a0#1"}); }, "is ambiguous");
  EXPECT_EQ(restore({"s2/neutral/a0#1"}).entry->keys, Keys{"s2/neutral/a0#1"});
}

TEST_F(CurationTest, ANodeWithAGapStaysOutOfUseWhateverIsRestored) {
  const std::string key = "s1/neutral/a0#" + std::to_string(corpus.sentences[0].nodes[4].row);
  prune({key});
  restore({key});
  test::expect_error([&] { table().find_node(key, ""); }, "has unfilled gaps");
}

TEST_F(CurationTest, SurvivesTheImportOfAnotherCorpus) {
  prune({"a2#3"});
  {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, test::made_corpus("b", 3));
  }
  EXPECT_EQ(pruned(), Keys{"s1/neutral/a2#3"});
  undo();
  EXPECT_TRUE(pruned().empty());
}

TEST_F(CurationTest, ALockedDatabaseSaysSo) {
  SQLite::Database other(path.string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  try {
    prune({"a2#3"});
    FAIL() << "no error";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("another program is writing to this database"),
              std::string::npos)
        << error.what();
  }
  other.exec("ROLLBACK");
  EXPECT_TRUE(prune({"a2#3"}).entry);
}

TEST_F(CurationTest, NeedsANameAReasonAndTheRightToWrite) {
  const auto curate = [&](const CurationRequest& request, OpenMode mode) {
    MotionDatabase::open(path, mode).curate(request);
  };
  const CurationRequest good{.keys = {"a2#3"}, .by = "ann", .reason = "why"};
  CurationRequest nameless = good, groundless = good;
  nameless.by.clear();
  groundless.reason.clear();
  EXPECT_THROW(curate(nameless, OpenMode::read_write), InternalError);
  EXPECT_THROW(curate(groundless, OpenMode::read_write), InternalError);
  EXPECT_THROW(curate(good, OpenMode::read_only), InternalError);
}

} // namespace
} // namespace phonomime
