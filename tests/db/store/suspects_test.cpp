// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/connection.h"
#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

SuspectMark mark(const std::string& reason, SuspectOrigin origin, double score) {
  return {.reason = reason,
          .origin = origin,
          .score = score,
          .first_frame = 3,
          .frame_count = 14,
          .groups = {"m1", "a \"quoted\" name"},
          .text = reason + ": m1 and more"};
}

struct SuspectsTest : ::testing::Test {
  test::TemporaryFolder folder;
  std::filesystem::path path = folder / "motion.db";
  test::MadeCorpus corpus = test::made_corpus("a", 4);

  void import() {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    test::import_corpus(database, corpus);
  }
  std::vector<NodeRecord> suspects() const {
    return MotionDatabase::open(path, OpenMode::read_only).list_nodes({.suspect = true});
  }
};

TEST_F(SuspectsTest, SentencesAreReadBackAsTheyWereStored) {
  corpus.sentences[2].nodes[1].has_gap = true;
  corpus.sentences[2].frame_has_gap[12] = 1;
  import();
  test::raw_query(path, "INSERT INTO prunings SELECT sentence_id, row, 'ann', '2026-01-02', 'jump' "
                        "FROM nodes WHERE sentence_id = 1 AND row = 2");
  std::vector<std::string> names;
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  database.for_each_stored_sentence([&](const StoredSentence& stored) {
    names.push_back(stored.emotion + "/" + stored.name);
    const auto original =
        std::find_if(corpus.sentences.begin(), corpus.sentences.end(), [&](const auto& sentence) {
          return sentence.id == stored.name && sentence.emotion == stored.emotion;
        });
    ASSERT_NE(original, corpus.sentences.end());
    EXPECT_EQ(stored.speaker, "s1");
    EXPECT_TRUE(stored.channels == original->channels);
    EXPECT_EQ(stored.frame_has_gap, original->frame_has_gap);
    ASSERT_EQ(stored.nodes.size(), original->nodes.size());
    for (std::size_t i = 0; i < stored.nodes.size(); ++i) {
      const ImportedNode& node = original->nodes[i];
      const TimedPhoneme& row = original->rows[static_cast<std::size_t>(node.row)];
      EXPECT_EQ(stored.nodes[i].row, node.row);
      EXPECT_EQ(stored.nodes[i].phoneme, row.phoneme.name);
      EXPECT_EQ(stored.nodes[i].duration_s, row.end_s - row.start_s);
      EXPECT_EQ(stored.nodes[i].first_frame, node.first_frame);
      EXPECT_EQ(stored.nodes[i].frame_count, node.frame_count);
      EXPECT_EQ(stored.nodes[i].has_gap, node.has_gap);
      EXPECT_EQ(stored.nodes[i].pruned, stored.id == 1 && node.row == 2);
    }
  });
  EXPECT_EQ(names,
            (std::vector<std::string>{"happiness/a1", "happiness/a3", "neutral/a0", "neutral/a2"}));
}

TEST_F(SuspectsTest, MarksOfTheChannelsAreReplacedAndThoseOfTheRecordingStay) {
  const SuspectMark frozen = mark("frozen", SuspectOrigin::recording, 2.5);
  corpus.sentences[0].nodes[1].suspect = {frozen};
  import();
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  const std::int32_t row = corpus.sentences[0].nodes[1].row;
  const SuspectMark jump = mark("jump", SuspectOrigin::channels, 4.0);
  const auto set = [&](std::vector<SuspectMark> marks) {
    database.replace_channel_suspects([&](MotionDatabase& locked) {
      std::int64_t id = 0;
      locked.for_each_stored_sentence(
          [&](const StoredSentence& sentence) { id = sentence.name == "a0" ? sentence.id : id; });
      return std::vector<NodeMarks>{{.sentence_id = id, .row = row, .marks = marks}};
    });
  };
  // What the recording shows is not said again.
  set({jump, mark("frozen", SuspectOrigin::channels, 9.0)});
  ASSERT_EQ(suspects().size(), 1u);
  EXPECT_EQ(suspects()[0].suspect, (std::vector<SuspectMark>{frozen, jump}));
  EXPECT_EQ(database.info().suspect, 1);
  set({});
  EXPECT_EQ(suspects().at(0).suspect, std::vector<SuspectMark>{frozen});
  test::expect_sound(path);
}

TEST_F(SuspectsTest, AJudgeThatFailsChangesNothing) {
  corpus.sentences[0].nodes[1].suspect = {mark("jump", SuspectOrigin::channels, 2.0)};
  import();
  const auto before = test::raw_dump(path);
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  EXPECT_THROW(database.replace_channel_suspects(
                   [](MotionDatabase&) -> std::vector<NodeMarks> { throw Interrupted(); }),
               Interrupted);
  EXPECT_EQ(test::raw_dump(path), before);
  // A node that is not there is refused, too late for the database but not for its content.
  EXPECT_ANY_THROW(database.replace_channel_suspects([](MotionDatabase&) {
    return std::vector<NodeMarks>{
        {.sentence_id = 99, .row = 1, .marks = {mark("jump", SuspectOrigin::channels, 2.0)}}};
  }));
  EXPECT_EQ(test::raw_dump(path), before);
}

TEST_F(SuspectsTest, AnImportSetsThoseOfAllCorporaAndCountsItsOwn) {
  import();
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  const test::MadeCorpus second = test::made_corpus("b", 2);
  ImportTransaction transaction = database.begin_import(test::made_layout(4), test::kRate_hz);
  transaction.add_phonemes(test::made_phonemes());
  for (const ImportedSentence& sentence : second.sentences) {
    transaction.add_sentence(sentence);
  }
  std::vector<NodeMarks> marks;
  transaction.for_each_stored_sentence([&](const StoredSentence& sentence) {
    marks.push_back({.sentence_id = sentence.id,
                     .row = sentence.nodes.front().row,
                     .marks = {mark("jump", SuspectOrigin::channels, 2.0)}});
  });
  EXPECT_EQ(marks.size(), 6u);
  transaction.set_channel_suspects(marks);
  EXPECT_EQ(transaction.count_suspects(), (std::map<std::string, std::int64_t>{{"jump", 2}}));
  transaction.set_pca(test::made_pca(12, 5), {});
  transaction.commit({.name = "b", .phoneme_set = "festival_us", .report_json = "{}"});
  EXPECT_EQ(suspects().size(), 6u);
}

TEST_F(SuspectsTest, DamagedMarksAreSaidToBe) {
  corpus.sentences[0].nodes[1].suspect = {mark("jump", SuspectOrigin::channels, 2.0)};
  import();
  for (const char* damage : {"not JSON", "[1]", "{}"}) {
    test::raw_query(path, std::string("UPDATE suspects SET groups_json = '") + damage + "'");
    test::expect_error([&] { suspects(); }, "a suspect whose mark cannot be read");
  }
}

} // namespace
} // namespace phonomime
