// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/expect_error.h"
#include "tests/support/mounts.h"
#include "tests/support/temporary_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

namespace fs = std::filesystem;
using test::input_error;
using test::TemporaryFolder;

struct OpenTest : ::testing::Test {
  TemporaryFolder folder;
  fs::path path = folder / "motion.db";

  void import_here() {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, test::made_corpus("a", 3));
  }
  std::string open_error(OpenMode mode) {
    return input_error([&] { MotionDatabase::open(path, mode); });
  }
  static bool says(const std::string& message, const std::string& words) {
    return message.find(words) != std::string::npos;
  }
};

TEST_F(OpenTest, AMissingFileCannotBeRead) {
  EXPECT_THROW(MotionDatabase::open(path, OpenMode::read_only), IoError);
  EXPECT_FALSE(fs::exists(path));
  EXPECT_THROW(MotionDatabase::open(folder / "no/such/motion.db", OpenMode::read_write), IoError);
}

TEST_F(OpenTest, WhatIsNoDatabaseIsRefusedAndKept) {
  const std::vector<std::string> contents = {
      "hello\n", std::string(5000, 'x'), std::string(16384, '\0'),
      std::string("SQLite format 3") + std::string(200, '\0')};
  for (const std::string& bytes : contents) {
    write_file(path, bytes);
    for (const OpenMode mode : {OpenMode::read_only, OpenMode::read_write}) {
      EXPECT_TRUE(says(open_error(mode), path.string() + ": this file is not a motion database"));
    }
    EXPECT_EQ(read_file(path), bytes);
  }
  write_file(path, "");
  EXPECT_TRUE(says(open_error(OpenMode::read_only), "this file is empty"));
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_TRUE(says(open_error(OpenMode::read_write), "got a folder"));
  fs::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_TRUE(says(open_error(OpenMode::read_only), "a motion database is a file"));
}

TEST_F(OpenTest, AnotherProgramsDatabaseIsRefusedAndKept) {
  write_file(path, "");
  test::raw_query(path, "PRAGMA application_id = 1196444487; CREATE TABLE features (x)");
  const std::string bytes = read_file(path);
  for (const OpenMode mode : {OpenMode::read_only, OpenMode::read_write}) {
    EXPECT_TRUE(says(open_error(mode), "belongs to another program"));
  }
  EXPECT_EQ(read_file(path), bytes);
  // One without an application_id, with a table.
  test::raw_query(path, "PRAGMA application_id = 0");
  EXPECT_TRUE(says(open_error(OpenMode::read_write), "belongs to another program"));
}

TEST_F(OpenTest, AFutureVersionIsRefusedByBothNumbers) {
  import_here();
  test::raw_query(path, "PRAGMA user_version = 12");
  for (const OpenMode mode : {OpenMode::read_only, OpenMode::read_write}) {
    EXPECT_TRUE(says(open_error(mode), "(expected schema version 1 to 4, got version 12)"));
  }
}

TEST_F(OpenTest, AnEmptyDatabaseIsReadAsEmpty) {
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  const MotionDatabase reader = MotionDatabase::open(path, OpenMode::read_only);
  EXPECT_TRUE(reader.empty());
  EXPECT_EQ(reader.info().nodes, 0);
  EXPECT_TRUE(reader.list_nodes({}).empty());
  EXPECT_TRUE(says(input_error([&] { reader.load_motion_table(""); }), "there is no corpus"));
}

TEST_F(OpenTest, NamesThatMeanSomethingToSqliteAreFiles) {
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  for (const char* name : {":memory:", "file:a?mode=memory", "100%41#?.db"}) {
    {
      MotionDatabase database = MotionDatabase::open(name, OpenMode::read_write);
      import_corpus(database, test::made_corpus("a", 1));
    }
    EXPECT_TRUE(fs::is_regular_file(folder / name)) << name;
    EXPECT_FALSE(MotionDatabase::open(name, OpenMode::read_only).empty());
  }
  fs::current_path(before);
}

// Every read of a damaged file ends in a phonomime error or in an answer.
void read_everything(const fs::path& path) {
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  database.info();
  database.list_nodes({});
  const MotionTable table = database.load_motion_table("");
  for (const SentenceInfo& sentence : table.sentences) {
    database.load_channels(sentence);
    database.load_head(sentence);
  }
}

TEST_F(OpenTest, TruncatedFilesAreRefused) {
  import_here();
  const std::string whole = read_file(path);
  for (std::size_t size = 1; size < whole.size(); size += whole.size() / 37) {
    write_file(path, whole.substr(0, size));
    const std::string message = input_error([&] { read_everything(path); });
    EXPECT_TRUE(says(message, path.string())) << size;
    input_error([&] { MotionDatabase::open(path, OpenMode::read_write); });
  }
}

TEST_F(OpenTest, FlippedBytesNeverCrash) {
  import_here();
  const std::string whole = read_file(path);
  std::mt19937_64 random(5);
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::string bytes = whole;
    // Headers and cell pointers of pages do more harm than the middle of a blob.
    for (int flip = 0; flip < 6; ++flip) {
      const std::size_t page = random() % (bytes.size() / 32768) * 32768;
      bytes[page + random() % (flip % 2 == 0 ? 120 : 32768)] = static_cast<char>(random());
    }
    write_file(path, bytes);
    try {
      read_everything(path);
    } catch (const Error& error) {
      ++refused;
      EXPECT_TRUE(says(error.what(), "motion.db")) << error.what();
      EXPECT_NE(error.error_class(), ErrorClass::internal) << error.what();
    }
  }
  EXPECT_GT(refused, 30);
}

// Values that SQLite takes but that no import writes.
TEST_F(OpenTest, ContentThatBreaksItsPromisesIsRefused) {
  import_here();
  const std::string whole = read_file(path);
  const auto refused = [&](const std::string& sql) {
    write_file(path, whole);
    test::raw_query(path,
                    "PRAGMA ignore_check_constraints = ON; PRAGMA foreign_keys = OFF; " + sql);
    const std::string message = input_error([&] { read_everything(path); });
    EXPECT_TRUE(says(message, path.string())) << sql << ": " << message;
  };
  refused("UPDATE settings SET rate_hz = -1.0");
  refused("UPDATE settings SET layout_json = '{'");
  refused("UPDATE sentences SET frame_count = 2000000000");
  refused("UPDATE sentences SET frame_count = 9000000000000000000");
  refused("UPDATE nodes SET first_frame = 58");
  refused("UPDATE nodes SET frame_count = -3");
  refused("UPDATE nodes SET frame_count = 9223372036854775807");
  refused("UPDATE nodes SET phoneme_id = 77");
  refused("UPDATE phonemes SET visibility = 'bright'");
  refused("DELETE FROM phonemes WHERE name = 'pau'");
  refused("DELETE FROM pca");
  refused("UPDATE pca SET dimensions = 1000000");
  refused("UPDATE pca SET basis = x'00'");
  refused("UPDATE speakers SET reference_pose = NULL");
  refused("DELETE FROM coefficients");
  refused(
      "UPDATE coefficients SET frames = CAST(zeroblob(length(frames) - 4) || x'0000c07f' AS BLOB)");
  refused(
      "UPDATE coefficients SET frames = CAST(x'0000807f' || zeroblob(length(frames) - 4) AS BLOB)");
  refused("UPDATE channels SET frames = x''");
  refused("UPDATE channels SET frames = CAST(zeroblob(length(frames) - 4) || x'0000c07f' AS BLOB)");
  refused("UPDATE head_poses SET poses = x'0001'");
  refused("DROP TABLE nodes");
}

TEST_F(OpenTest, AReadOnlyFileIsReadButNotWritten) {
  import_here();
  const uid_t user = geteuid();
  constexpr uid_t kNobody = 65534;
  if (user == 0) { // root may write to a read-only file: somebody else tries
    for (fs::path place = path.parent_path();
         place != place.root_path() && place != fs::temp_directory_path();
         place = place.parent_path()) {
      fs::permissions(place, fs::perms::all);
    }
  }
  fs::permissions(path, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
  EXPECT_FALSE(MotionDatabase::open(path, OpenMode::read_only).empty());
  ASSERT_TRUE(user != 0 || seteuid(kNobody) == 0);
  EXPECT_THROW(MotionDatabase::open(path, OpenMode::read_write), IoError);
  ASSERT_TRUE(user != 0 || seteuid(user) == 0);
}

TEST_F(OpenTest, ReadOnlyMediaAreRead) {
  import_here();
  const auto media = test::Mount::read_only(folder.path());
  PHONOMIME_NEEDS_MOUNT(media);
  read_everything(path);
  try {
    MotionDatabase::open(path, OpenMode::read_write);
    FAIL() << "opened for writing";
  } catch (const IoError& error) {
    EXPECT_TRUE(says(error.what(), "the database cannot be written"));
  }
  EXPECT_THROW(MotionDatabase::open(folder / "new.db", OpenMode::read_write), IoError);
}

// As a program that ends while it reads leaves it: WAL in the header, no WAL.
TEST_F(OpenTest, AWalDatabaseIsReadFromReadOnlyMedia) {
  import_here();
  std::string bytes = read_file(path);
  bytes[18] = bytes[19] = 2;
  write_file(path, bytes);
  const auto media = test::Mount::read_only(folder.path());
  PHONOMIME_NEEDS_MOUNT(media);
  read_everything(path);
}

// Without what is in the WAL the file may be half of a checkpoint.
TEST_F(OpenTest, AnUnfinishedWalOnReadOnlyMediaIsRefused) {
  import_here();
  std::string bytes = read_file(path);
  bytes[18] = bytes[19] = 2;
  write_file(path, bytes);
  write_file(path.string() + "-wal", std::string(40000, '\1'));
  const auto media = test::Mount::read_only(folder.path());
  PHONOMIME_NEEDS_MOUNT(media);
  try {
    MotionDatabase::open(path, OpenMode::read_only);
    FAIL() << "opened";
  } catch (const IoError& error) {
    EXPECT_TRUE(says(error.what(), "-wal")) << error.what();
  }
}

} // namespace
} // namespace phonomime
