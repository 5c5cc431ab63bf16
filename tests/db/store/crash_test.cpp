// SPDX-License-Identifier: GPL-3.0-or-later
// After a kill -9 or a full disk at any moment of an import the database is as before or as after.
#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/mounts.h"
#include "tests/support/temporary_folder.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <thread>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

namespace fs = std::filesystem;
using Dump = std::vector<std::string>;

struct Outcome {
  bool killed = false;
  int status = 0;
  long operations = 0;
  std::string message;
};

struct CrashTest : ::testing::Test {
  test::TemporaryFolder folder;
  fs::path path = folder / "motion.db";

  CrashTest() { setenv("SOURCE_DATE_EPOCH", "0", 1); }
  ~CrashTest() override { unsetenv("SOURCE_DATE_EPOCH"); }

  pid_t start(const fs::path& db, const std::string& name, std::vector<std::string> fate) {
    std::vector<std::string> words = {STORE_IMPORT_CHILD, db.string(), name, "20", "150"};
    words.insert(words.end(), fate.begin(), fate.end());
    std::vector<char*> arguments;
    for (std::string& word : words) {
      arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    const std::string out = (folder / "out").string(), err = (folder / "err").string();
    posix_spawn_file_actions_addopen(&files, 1, out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    posix_spawn_file_actions_addopen(&files, 2, err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    pid_t child = -1;
    const int failure =
        posix_spawn(&child, STORE_IMPORT_CHILD, &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    EXPECT_EQ(failure, 0);
    return child;
  }

  Outcome wait_for(pid_t child) {
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    Outcome outcome;
    outcome.killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.operations = parse_integer(trim(read_file(folder / "out"))).value_or(0);
    outcome.message = read_file(folder / "err");
    EXPECT_TRUE(outcome.killed || WIFEXITED(status)) << outcome.message;
    return outcome;
  }

  Outcome import(const fs::path& db, const std::string& name, std::vector<std::string> fate = {}) {
    return wait_for(start(db, name, std::move(fate)));
  }

  // A database with corpus a, what it holds, and what it holds once b is in.
  Dump before, after;
  long operations = 0; // of importing b
  std::string whole;   // the file
  void prepare() {
    ASSERT_EQ(import(path, "a").status, 0);
    before = test::raw_dump(path);
    whole = read_file(path);
    const Outcome outcome = import(path, "b");
    ASSERT_EQ(outcome.status, 0) << outcome.message;
    operations = outcome.operations;
    after = test::raw_dump(path);
    ASSERT_GT(operations, 60);
    ASSERT_NE(before, after);
  }
  void reset() {
    for (const char* suffix : {"-wal", "-shm", "-journal"}) {
      fs::remove(path.string() + suffix);
    }
    write_file(path, whole);
  }

  // Opened by a reader, then by a writer. True where b is in it.
  bool is_after() {
    std::size_t corpora = 0;
    {
      const MotionDatabase reader = MotionDatabase::open(path, OpenMode::read_only);
      corpora = reader.info().corpora.size();
      EXPECT_EQ(reader.load_motion_table("").sentences.size(), corpora * 20);
    }
    { MotionDatabase::open(path, OpenMode::read_write); }
    test::expect_alone_and_whole(path);
    test::expect_sound(path);
    const bool complete = corpora == 2;
    EXPECT_EQ(test::raw_dump(path) == (complete ? after : before), true)
        << "neither as before nor as after";
    return complete;
  }

  // Operations to fail at: spread over all, and every one of the last, where the commit is.
  std::vector<long> moments(long count) const {
    std::vector<long> chosen;
    for (long i = 1; i <= operations;
         i += i < operations - 25 ? std::max(1L, operations / count) : 1) {
      chosen.push_back(i);
    }
    return chosen;
  }
};

TEST_F(CrashTest, AKillAtAnyWriteLeavesBeforeOrAfter) {
  prepare();
  int befores = 0, afters = 0;
  for (const long moment : moments(40)) {
    SCOPED_TRACE("operation " + std::to_string(moment) + " of " + std::to_string(operations));
    reset();
    ASSERT_TRUE(import(path, "b", {"kill-at", std::to_string(moment)}).killed);
    (is_after() ? afters : befores) += 1;
  }
  EXPECT_GT(befores, 20);
  EXPECT_GT(afters, 0);
}

TEST_F(CrashTest, AKillAtAnyMomentLeavesBeforeOrAfter) {
  prepare();
  reset();
  const auto start_time = std::chrono::steady_clock::now();
  ASSERT_EQ(import(path, "b").status, 0);
  const auto duration = std::chrono::steady_clock::now() - start_time;
  std::mt19937_64 random(3);
  int killed = 0;
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    reset();
    const pid_t child = start(path, "b", {});
    std::this_thread::sleep_for(duration * static_cast<int>(random() % 100) / 100);
    kill(child, SIGKILL);
    killed += wait_for(child).killed ? 1 : 0;
    is_after();
  }
  EXPECT_GT(killed, 0);
}

// What was left is finished by the next import.
TEST_F(CrashTest, AfterAKillTheImportCanBeRepeated) {
  prepare();
  for (const long moment : moments(6)) {
    reset();
    ASSERT_TRUE(import(path, "b", {"kill-at", std::to_string(moment)}).killed);
    const Outcome again = import(path, "b");
    if (again.status != 0) { // it was in already
      EXPECT_NE(again.message.find("is in the database already"), std::string::npos);
    }
    EXPECT_TRUE(is_after());
  }
}

TEST_F(CrashTest, AKillInTheFirstImportLeavesNothingOrAnEmptyDatabase) {
  const Outcome whole_import = import(path, "a");
  ASSERT_EQ(whole_import.status, 0);
  const Dump complete = test::raw_dump(path);
  operations = whole_import.operations;
  for (const long moment : moments(20)) {
    SCOPED_TRACE("operation " + std::to_string(moment) + " of " + std::to_string(operations));
    for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
      fs::remove(path.string() + suffix);
    }
    ASSERT_TRUE(import(path, "a", {"kill-at", std::to_string(moment)}).killed);
    const bool empty = MotionDatabase::open(path, OpenMode::read_write).empty();
    if (empty) {
      EXPECT_EQ(import(path, "a").status, 0);
    }
    EXPECT_TRUE(test::raw_dump(path) == complete);
    test::expect_sound(path);
  }
}

TEST_F(CrashTest, AFullDiskIsAnErrorAndLeavesTheDatabaseAsItWas) {
  prepare();
  int refused = 0;
  for (const long moment : moments(12)) {
    SCOPED_TRACE("operation " + std::to_string(moment) + " of " + std::to_string(operations));
    reset();
    const Outcome outcome = import(path, "b", {"full-at", std::to_string(moment)});
    ASSERT_FALSE(outcome.killed);
    const bool complete = is_after();
    // Once COMMIT is in the WAL the import is done, even where it stays there.
    EXPECT_EQ(complete, outcome.status == 0) << outcome.message;
    if (!complete) {
      ++refused;
      EXPECT_EQ(outcome.status, 4) << outcome.message;
      EXPECT_NE(outcome.message.find("motion.db: the disk is full"), std::string::npos)
          << outcome.message;
    }
  }
  EXPECT_GE(refused, 8);
}

TEST_F(CrashTest, ALimitOnFileSizesIsAnErrorAndLeavesTheDatabaseAsItWas) {
  prepare();
  for (const long bytes : {50'000L, 200'000L, 600'000L}) {
    reset();
    const Outcome outcome = import(path, "b", {"limit", std::to_string(bytes)});
    EXPECT_EQ(outcome.status, 4);
    EXPECT_NE(outcome.message.find("motion.db: the database cannot be"), std::string::npos)
        << outcome.message;
    EXPECT_FALSE(is_after());
  }
}

std::vector<fs::path> files_in(const fs::path& folder) {
  return {fs::directory_iterator(folder), {}};
}

TEST_F(CrashTest, ADiskThatReallyFillsUpInTheFirstImportIsEmptyAgain) {
  const auto disk = test::Mount::small_disk(folder / "small", "1000k");
  PHONOMIME_NEEDS_MOUNT(disk);
  const Outcome outcome = import(folder / "small/motion.db", "a");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_NE(outcome.message.find("the disk is full"), std::string::npos) << outcome.message;
  EXPECT_EQ(files_in(folder / "small"), std::vector<fs::path>{});
}

TEST_F(CrashTest, ADiskThatReallyFillsUpKeepsWhatItHeld) {
  const auto disk = test::Mount::small_disk(folder / "small", "3900k");
  PHONOMIME_NEEDS_MOUNT(disk);
  path = folder / "small/motion.db";
  const Outcome first = import(path, "a");
  ASSERT_EQ(first.status, 0) << first.message;
  const Dump held = test::raw_dump(path);
  const Outcome second = import(path, "b");
  EXPECT_EQ(second.status, 4);
  EXPECT_NE(second.message.find("the disk is full"), std::string::npos) << second.message;
  EXPECT_TRUE(test::raw_dump(path) == held);
  EXPECT_EQ(files_in(folder / "small"), std::vector<fs::path>{path});
  test::expect_alone_and_whole(path);
}

} // namespace
} // namespace phonomime
