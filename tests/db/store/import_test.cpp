// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

namespace fs = std::filesystem;
using test::import_corpus;
using test::made_corpus;
using test::made_layout;
using test::made_sentence;
using test::raw_dump;
using test::TemporaryFolder;

struct ImportTest : ::testing::Test {
  TemporaryFolder folder;
  fs::path path = folder / "motion.db";

  ImportTest() { setenv("SOURCE_DATE_EPOCH", "86399", 1); }
  ~ImportTest() override { unsetenv("SOURCE_DATE_EPOCH"); }

  void import(const test::MadeCorpus& corpus) {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, corpus);
  }
};

TEST_F(ImportTest, LeavesOneFileThatCanBeCopied) {
  import(made_corpus("a", 6));
  test::expect_alone_and_whole(path);
  test::expect_sound(path);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  fs::copy_file(path, folder / "copy.db");
  const MotionDatabase copy = MotionDatabase::open(folder / "copy.db", OpenMode::read_only);
  EXPECT_FALSE(copy.empty());
  EXPECT_EQ(copy.info().corpora[0].imported_at, "1970-01-01T23:59:59Z");
  EXPECT_EQ(raw_dump(folder / "copy.db"), raw_dump(path));
}

TEST_F(ImportTest, TheFileIsWholeRightAfterCommit) {
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  import_corpus(database, made_corpus("a", 3));
  test::expect_alone_and_whole(path);
}

TEST_F(ImportTest, TheSameCorpusGivesTheSameContent) {
  import(made_corpus("a", 6));
  const auto first = raw_dump(path);
  const std::string bytes = read_file(path);
  fs::remove(path);
  import(made_corpus("a", 6));
  EXPECT_EQ(raw_dump(path), first);
  EXPECT_EQ(read_file(path), bytes);
}

TEST_F(ImportTest, ASecondCorpusRefitsTheWhole) {
  import(made_corpus("a", 4));
  test::MadeCorpus second = made_corpus("b", 5);
  second.dimensions = 7;
  second.pca_seed = 99;
  {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, second);
    EXPECT_EQ(database.info().corpora.size(), 2u);
  }
  test::expect_alone_and_whole(path);
  const MotionTable table = MotionDatabase::open(path, OpenMode::read_only).load_motion_table("");
  ASSERT_EQ(table.sentences.size(), 9u);
  ASSERT_EQ(table.coefficients.cols(), 7);
  const PcaModel pca = test::made_pca(12, 7, 99);
  // Sentences of both corpora, in order of keys: happiness/a1 is first, neutral/b4 last.
  const auto first = made_corpus("a", 4).sentences[1];
  const auto last = second.sentences[4];
  EXPECT_TRUE(table.coefficients.row(0).transpose().cast<double>().isApprox(
      pca.project(first.channels.row(0).transpose().cast<double>()), 1e-6));
  EXPECT_TRUE(table.coefficients.bottomRows(1).transpose().cast<double>().isApprox(
      pca.project(last.channels.bottomRows(1).transpose().cast<double>()), 1e-6));
}

TEST_F(ImportTest, VisitsEverySentenceInOrderOfKeys) {
  import(made_corpus("a", 4));
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
  import.add_phonemes(test::made_phonemes());
  ImportedSentence early = made_sentence("s0", "neutral", "z", 1);
  early.frame_has_gap[3] = 1;
  import.add_sentence(early);
  std::vector<FrameMatrix> seen;
  std::vector<std::uint8_t> gaps;
  import.for_each_sentence(
      [&](const FrameMatrix& channels, const std::vector<std::uint8_t>& frame_has_gap) {
        seen.push_back(channels);
  gaps.insert(gaps.end(), frame_has_gap.begin(), frame_has_gap.end());
});
const auto a = made_corpus("a", 4).sentences;
ASSERT_EQ(seen.size(), 5u);
EXPECT_EQ(seen[0], early.channels);
EXPECT_EQ(seen[1], a[1].channels);
EXPECT_EQ(seen[2], a[3].channels);
EXPECT_EQ(seen[3], a[0].channels);
EXPECT_EQ(seen[4], a[2].channels);
EXPECT_EQ(std::count(gaps.begin(), gaps.end(), 1), 1);
EXPECT_EQ(gaps[3], 1);
} // namespace

// Failures: what was there before is there afterwards, to the byte of the content.

TEST_F(ImportTest, WithoutCommitNothingIsLeft) {
  {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    EXPECT_TRUE(database.empty());
    ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
    import.add_phonemes(test::made_phonemes());
    import.add_sentence(made_sentence("s1", "neutral", "a", 1));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(ImportTest, AnEmptyFileIsEmptyAgainAfterAFailedImport) {
  write_file(path, "");
  { MotionDatabase::open(path, OpenMode::read_write); }
  EXPECT_EQ(fs::file_size(path), 0u);
  import(made_corpus("a", 2));
  test::expect_sound(path);
}

TEST_F(ImportTest, ARollbackKeepsTheEarlierCorpus) {
  import(made_corpus("a", 3));
  const auto before = raw_dump(path);
  {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
    import.add_phonemes(test::made_phonemes());
    import.add_sentence(made_sentence("s2", "anger", "x", 1));
    import.set_pca(test::made_pca(12, 3), {});
  }
  EXPECT_EQ(raw_dump(path), before);
  test::expect_alone_and_whole(path);
}

TEST_F(ImportTest, AStopWhileProjectingRollsBack) {
  const std::atomic<bool> stop = true;
  {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
    import.add_phonemes(test::made_phonemes());
    import.add_sentence(made_sentence("s2", "anger", "x", 1));
    EXPECT_THROW(import.set_pca(test::made_pca(12, 3), {.report = {}, .stop = &stop}), Interrupted);
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(ImportTest, ARepeatedSentenceIsRefused) {
  import(made_corpus("a", 2));
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
  import.add_phonemes(test::made_phonemes());
  EXPECT_TRUE(import.has_sentence("s1", "neutral", "a0"));
  EXPECT_FALSE(import.has_sentence("s1", "happiness", "a0"));
  EXPECT_NE(test::input_error([&] {
              import.add_sentence(made_sentence("s1", "neutral", "a0", 9));
            }).find("sentence s1/neutral/a0 is in the database already"),
            std::string::npos);
  import.add_sentence(made_sentence("s1", "happiness", "a0", 9)); // another triple
}

TEST_F(ImportTest, ADifferentLayoutOrRateIsRefused) {
  import(made_corpus("a", 2));
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  const auto message = [&](const Layout& layout, double rate_hz) {
    return test::input_error([&] { database.begin_import(layout, rate_hz); });
  };
  EXPECT_NE(message(made_layout(5), 100.0).find("number of channel groups (expected 4, got 5)"),
            std::string::npos);
  EXPECT_NE(message(made_layout(), 120.0).find("(expected 100 Hz, got 120 Hz)"), std::string::npos);
  Layout renamed = made_layout();
  renamed.groups[2].name = "chin";
  EXPECT_NE(message(renamed, 100.0).find("channel group 2 (expected \"m2\", got \"chin\")"),
            std::string::npos);
  import_corpus(database, made_corpus("b", 2)); // the connection is still good
}

TEST_F(ImportTest, AnotherMeaningOfAPhonemeIsRefused) {
  import(made_corpus("a", 2));
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
  import.add_phonemes(test::made_phonemes());
  const std::string message = test::input_error([&] {
    import.add_phonemes({{ "b", "aa", Visibility::high }});
  });
  EXPECT_NE(message.find("\"b\""), std::string::npos);
  EXPECT_NE(message.find("(expected viseme \"p\", visibility high, got viseme \"aa\", visibility "
                         "high)"),
            std::string::npos)
      << message;
}

// Mistakes of a caller.
TEST_F(ImportTest, AnIncompleteImportCannotBeCommitted) {
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  {
    ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
    EXPECT_THROW(import.commit({.name = "none"}), InputError);
    EXPECT_THROW(import.add_sentence(made_sentence("s1", "neutral", "a", 1)), InternalError);
    import.add_phonemes(test::made_phonemes());
    ImportedSentence bad = made_sentence("s1", "neutral", "b", 1);
    bad.nodes[1].first_frame -= 1;
    EXPECT_THROW(import.add_sentence(bad), InternalError);
    bad = made_sentence("s1", "neutral", "b", 1);
    bad.channels(3, 4) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(import.add_sentence(bad), InternalError);
  }
  ImportTransaction import = database.begin_import(made_layout(), test::kRate_hz);
  import.add_phonemes(test::made_phonemes());
  import.add_sentence(made_sentence("s1", "neutral", "a", 1));
  EXPECT_THROW(import.commit({.name = "no pose"}), InternalError);
  import.set_reference_pose("s1", Eigen::VectorXd::Zero(12));
  EXPECT_THROW(import.commit({.name = "no pca"}), InternalError);
  import.set_pca(test::made_pca(12, 3), {});
  import.commit({.name = "complete"});
  EXPECT_THROW(import.add_phonemes(test::made_phonemes()), InternalError);
  EXPECT_EQ(database.info().corpora.at(0).name, "complete");
}

TEST_F(ImportTest, AnImportOutlivesItsDatabaseObject) {
  auto database = std::make_optional(MotionDatabase::open(path, OpenMode::read_write));
  {
    ImportTransaction import = database->begin_import(made_layout(), test::kRate_hz);
    database.reset();
    import.add_phonemes(test::made_phonemes());
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(ImportTest, ReadersSeeTheOldStateUntilCommit) {
  import(made_corpus("a", 3));
  MotionDatabase writer = MotionDatabase::open(path, OpenMode::read_write);
  const MotionDatabase reader = MotionDatabase::open(path, OpenMode::read_only);
  {
    ImportTransaction import = writer.begin_import(made_layout(), test::kRate_hz);
    import.add_phonemes(test::made_phonemes());
    import.add_sentence(made_sentence("s1", "anger", "x", 1));
    EXPECT_EQ(reader.info().sentences, 3);
    EXPECT_EQ(reader.load_motion_table("").sentences.size(), 3u);
    EXPECT_EQ(writer.info().sentences, 4);
    import.set_pca(test::made_pca(12, 3), {});
    import.commit({.name = "b"});
  }
  EXPECT_EQ(reader.info().sentences, 4);
}

TEST_F(ImportTest, ASecondWriterIsToldToWait) {
  import(made_corpus("a", 3));
  MotionDatabase first = MotionDatabase::open(path, OpenMode::read_write);
  MotionDatabase second = MotionDatabase::open(path, OpenMode::read_write);
  {
    ImportTransaction import = first.begin_import(made_layout(), test::kRate_hz);
    import.add_phonemes(test::made_phonemes());
    import.add_sentence(made_sentence("s1", "anger", "x", 1));
    try {
      second.begin_import(made_layout(), test::kRate_hz);
      FAIL() << "two imports at once";
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find("another program is writing to this database"),
                std::string::npos);
    }
    import.set_pca(test::made_pca(12, 3), {});
    import.commit({.name = "b"});
  }
  import_corpus(second, made_corpus("c", 2));
  EXPECT_EQ(first.info().corpora.size(), 3u);
}

// The first of two makes the file, fails and takes it away, while the second has it open.
TEST_F(ImportTest, AFileThatWasTakenAwayIsNotWrittenTo) {
  auto first = std::make_optional(MotionDatabase::open(path, OpenMode::read_write));
  MotionDatabase second = MotionDatabase::open(path, OpenMode::read_write);
  first.reset();
  ASSERT_FALSE(fs::exists(path));
  try {
    second.begin_import(made_layout(), test::kRate_hz);
    FAIL() << "an import into a file that is gone";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("has removed or replaced this database"),
              std::string::npos)
        << error.what();
  }
}

} // namespace phonomime
} // namespace phonomime
