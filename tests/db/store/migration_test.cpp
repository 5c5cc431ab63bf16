// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/connection.h"
#include "db/store/schema.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

namespace phonomime::store {
namespace {

using test::raw_query;

constexpr std::string_view kMade2 =
    "CREATE TABLE maps (id INTEGER PRIMARY KEY, name TEXT NOT NULL) STRICT;"
    "INSERT INTO maps SELECT id, name FROM corpora;";
constexpr std::string_view kMade3 = "ALTER TABLE maps ADD COLUMN stale INTEGER NOT NULL DEFAULT 1;";
constexpr std::string_view kBroken = "CREATE TABLE half (x); INSERT INTO nowhere VALUES (1);";
constexpr std::string_view kDangling = "PRAGMA defer_foreign_keys = ON;"
                                       "INSERT INTO coefficients VALUES (99, x'00');";

struct MigrationTest : ::testing::Test {
  test::TemporaryFolder folder;
  std::filesystem::path path = folder / "motion.db";
  std::vector<Migration> later = built_in_migrations();
  int built_in = static_cast<int>(later.size());

  MigrationTest() {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, test::made_corpus("a", 2));
  }
  void add(std::string_view sql) { later.push_back({static_cast<int>(later.size()) + 1, sql}); }
  void open(OpenMode mode) { Connection::open(path, mode, later); }
  std::string version() { return raw_query(path, "PRAGMA user_version").at(0); }
};

TEST_F(MigrationTest, BuiltInMigrationsMakeTheSchemaOfTheHeader) {
  EXPECT_EQ(version(), std::to_string(built_in));
  EXPECT_EQ(raw_query(path, "PRAGMA application_id").at(0), std::to_string(kApplicationId));
}

TEST_F(MigrationTest, AnOlderVersionIsBroughtUpStepByStep) {
  const auto sentences = raw_query(path, "SELECT * FROM sentences");
  add(kMade2);
  add(kMade3);
  open(OpenMode::read_write);
  EXPECT_EQ(version(), std::to_string(built_in + 2));
  EXPECT_EQ(raw_query(path, "SELECT id, name, stale FROM maps"), std::vector<std::string>{"1|a|1"});
  EXPECT_EQ(raw_query(path, "SELECT * FROM sentences"), sentences);
  test::expect_sound(path);
  test::expect_alone_and_whole(path);
  open(OpenMode::read_write); // once is enough
  EXPECT_EQ(raw_query(path, "SELECT count(*) FROM maps"), std::vector<std::string>{"1"});
}

TEST_F(MigrationTest, ReadingMigratesToo) {
  add(kMade2);
  open(OpenMode::read_only);
  EXPECT_EQ(version(), std::to_string(built_in + 1));
}

TEST_F(MigrationTest, ANewDatabaseGoesThroughAllSteps) {
  add(kMade2);
  const std::filesystem::path fresh = folder / "new.db";
  const auto connection = Connection::open(fresh, OpenMode::read_write, later);
  EXPECT_EQ(raw_query(fresh, "PRAGMA user_version").at(0), std::to_string(built_in + 1));
}

TEST_F(MigrationTest, AFailedStepChangesNothing) {
  add(kMade2);
  add(kBroken);
  const auto before = test::raw_dump(path);
  EXPECT_THROW(open(OpenMode::read_write), Error);
  EXPECT_EQ(version(), std::to_string(built_in));
  EXPECT_EQ(test::raw_dump(path), before);
}

TEST_F(MigrationTest, AStepThatBreaksReferencesIsUndone) {
  add(kDangling);
  const auto before = test::raw_dump(path);
  EXPECT_THROW(open(OpenMode::read_write), InternalError);
  EXPECT_EQ(test::raw_dump(path), before);
}

TEST_F(MigrationTest, AMigratedDatabaseIsRefusedByAnOlderProgram) {
  add(kMade2);
  open(OpenMode::read_write);
  const std::string message =
      test::input_error([&] { MotionDatabase::open(path, OpenMode::read_only); });
  EXPECT_NE(message.find("version " + std::to_string(built_in + 1)), std::string::npos);
}

// Databases that older versions of the program have made (tests/data).
TEST(OldDatabases, Version1IsRead) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "old.db";
  std::filesystem::copy_file(
      std::filesystem::path(PHONOMIME_SOURCE_DIR) / "tests/data/motion_database_v1.db", path);
  ASSERT_EQ(raw_query(path, "PRAGMA user_version"), std::vector<std::string>{"1"});
  std::vector<std::string> before = test::raw_dump(path);
  const MotionTable table =
      MotionDatabase::open(path, OpenMode::read_only).load_motion_table("ann");
  EXPECT_EQ(raw_query(path, "PRAGMA user_version"),
            std::vector<std::string>{std::to_string(built_in_migrations().back().version)});
  EXPECT_EQ(table.nodes.size(), 11u);
  EXPECT_EQ(table.unavailable.size(), 1u);
  EXPECT_EQ(table.coefficients.cols(), 4);
  EXPECT_GT(table.coefficients.norm(), 1.0F);
  EXPECT_TRUE(MotionDatabase::open(path, OpenMode::read_only).list_maps("ann").empty());
  // All that there was is there as it was, but for suspects, which have a table of another name.
  std::vector<std::string> after = test::raw_dump(path);
  std::erase_if(before, [](const std::string& row) {
    return row.find("suspect_marks") != std::string::npos;
  });
  std::ranges::sort(before);
  std::ranges::sort(after);
  EXPECT_TRUE(std::ranges::includes(after, before));
  test::expect_sound(path);
  test::expect_alone_and_whole(path);
}

TEST(OldDatabases, SuspectsOfVersion2KeepTheirTextsAndAreToldApart) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "old.db";
  std::filesystem::copy_file(
      std::filesystem::path(PHONOMIME_SOURCE_DIR) / "tests/data/motion_database_v2.db", path);
  ASSERT_EQ(raw_query(path, "PRAGMA user_version"), std::vector<std::string>{"2"});
  const std::vector<std::string> maps = raw_query(path, "SELECT * FROM phoneme_maps");
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  const std::vector<NodeRecord> suspects = database.list_nodes({.suspect = true});
  ASSERT_EQ(suspects.size(), 2u);
  const SuspectMark& jump = suspects[0].suspect.at(0);
  EXPECT_EQ(jump.reason, "jump");
  EXPECT_EQ(jump.origin, SuspectOrigin::channels);
  EXPECT_EQ(jump.text, "jump: lip_up at 1.24 s, 812 mm/s");
  EXPECT_EQ(jump.score, 1.0);
  EXPECT_EQ(jump.frame_count, suspects[0].frame_count);
  EXPECT_EQ(suspects[1].suspect.at(0).reason, "frozen");
  EXPECT_EQ(suspects[1].suspect.at(0).origin, SuspectOrigin::recording);
  EXPECT_EQ(raw_query(path, "SELECT * FROM phoneme_maps"), maps);
  // A pruning of before the journal can be ended.
  const std::vector<NodeRecord> pruned = database.list_nodes({.pruned = true});
  ASSERT_EQ(pruned.size(), 1u);
  EXPECT_TRUE(database.journal().empty());
  database = MotionDatabase::open(path, OpenMode::read_write);
  database.curate(
      {.action = CurationAction::restore, .keys = {pruned[0].key}, .by = "ann", .reason = "fine"});
  EXPECT_TRUE(database.list_nodes({.pruned = true}).empty());
  test::expect_sound(path);
}

TEST(OldDatabases, Version3KeepsItsJournalAndHasNoStyleModelYet) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "old.db";
  std::filesystem::copy_file(
      std::filesystem::path(PHONOMIME_SOURCE_DIR) / "tests/data/motion_database_v3.db", path);
  ASSERT_EQ(raw_query(path, "PRAGMA user_version"), std::vector<std::string>{"3"});
  std::vector<std::string> before = test::raw_dump(path);
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  EXPECT_FALSE(database.load_style_model("ann"));
  EXPECT_EQ(database.journal().size(), 3u);
  const MotionTable table = database.load_motion_table("ann");
  EXPECT_EQ(table.nodes.size(), 11u);
  EXPECT_EQ(table.unavailable.size(), 1u);
  // All that there was is there as it was.
  std::vector<std::string> after = test::raw_dump(path);
  std::ranges::sort(before);
  std::ranges::sort(after);
  EXPECT_TRUE(std::ranges::includes(after, before));
  test::expect_sound(path);
}

} // namespace
} // namespace phonomime::store
