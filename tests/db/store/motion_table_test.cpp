// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "tests/db/store/made_corpus.h"
#include "tests/db/store/raw_database.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <omp.h>

namespace phonomime {
namespace {

using test::import_corpus;
using test::made_pca;
using test::made_sentence;
using test::TemporaryFolder;

// Sentences in an order that is not the keys', with one inner pause (seed 4), a gap and marks.
test::MadeCorpus mixed_corpus() {
  test::MadeCorpus corpus;
  corpus.sentences = {
      made_sentence("s1", "neutral", "b", 1),   made_sentence("s2", "neutral", "a", 2),
      made_sentence("s1", "happiness", "Z", 4), made_sentence("s1", "neutral", "B", 3),
      made_sentence("s1", "neutral", "é", 5),   made_sentence("s1", "happiness", "b", 6)};
  corpus.sentences[0].nodes[2].has_gap = true;
  corpus.sentences[0].nodes[1].suspect = {{.reason = "jump", .score = 3.5, .text = "jump: far"},
                                          {.reason = "closed", .score = 1.25, .text = "closed"}};
  return corpus;
}

struct MotionTableTest : ::testing::Test {
  TemporaryFolder folder;
  std::filesystem::path path = folder / "motion.db";
  test::MadeCorpus corpus = mixed_corpus();

  void import() {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    import_corpus(database, corpus);
  }
  MotionTable load(const std::string& speaker) const {
    return MotionDatabase::open(path, OpenMode::read_only).load_motion_table(speaker);
  }
  const ImportedSentence& original(const SentenceInfo& info) const {
    return *std::find_if(corpus.sentences.begin(), corpus.sentences.end(), [&](const auto& s) {
      return s.speaker == info.speaker && s.emotion == info.emotion && s.id == info.id;
    });
  }
  static std::string full_key(const ImportedSentence& s, int row) {
    return s.speaker + "/" + s.emotion + "/" + s.id + "#" + std::to_string(row);
  }
};

TEST_F(MotionTableTest, HoldsEveryUsableNodeInOrderOfKeys) {
  import();
  const MotionTable table = load("s1");
  std::vector<std::string> sentences;
  for (const SentenceInfo& sentence : table.sentences) {
    sentences.push_back(sentence.emotion + "/" + sentence.id);
    EXPECT_EQ(sentence.text, "text of " + sentence.id);
  }
  // Bytewise: capitals before small letters before UTF-8.
  EXPECT_EQ(sentences, (std::vector<std::string>{"happiness/Z", "happiness/b", "neutral/B",
                                                 "neutral/b", "neutral/é"}));
  std::size_t expected = 0;
  for (const ImportedSentence& sentence : corpus.sentences) {
    expected += sentence.speaker == "s1" ? sentence.nodes.size() : 0;
  }
  EXPECT_EQ(table.nodes.size(), expected - 1); // one has a gap
  for (std::size_t i = 0; i < table.nodes.size(); ++i) {
    const MotionNode& node = table.nodes[i];
    const SentenceInfo& info = table.sentences[static_cast<std::size_t>(node.sentence)];
    const ImportedSentence& from = original(info);
    const auto row = static_cast<std::size_t>(node.order);
    const auto phoneme = [&](std::int32_t index) {
      return table.phonemes[static_cast<std::size_t>(index)];
    };
    EXPECT_EQ(phoneme(node.phoneme), from.rows[row].phoneme);
    EXPECT_EQ(phoneme(node.previous_phoneme), from.rows[row - 1].phoneme);
    EXPECT_EQ(phoneme(node.next_phoneme), from.rows[row + 1].phoneme);
    EXPECT_EQ(table.visemes[static_cast<std::size_t>(node.viseme)], from.rows[row].phoneme.viseme);
    EXPECT_EQ(table.emotions[static_cast<std::size_t>(node.emotion)], from.emotion);
    if (i > 0) {
      const MotionNode& previous = table.nodes[i - 1];
      EXPECT_TRUE(previous.sentence < node.sentence ||
                  (previous.sentence == node.sentence && previous.order < node.order));
    }
  }
}

TEST_F(MotionTableTest, FirstPhonemeAndVisemeAreSilenceAndTheRestIsKnown) {
  import();
  const MotionTable table = load("s2");
  ASSERT_EQ(table.phonemes.size(), test::made_phonemes().size());
  EXPECT_EQ(table.phonemes[0].name, "pau");
  EXPECT_EQ(table.visemes[0], "pau");
  for (const Phoneme& phoneme : test::made_phonemes()) {
    EXPECT_NE(std::find(table.phonemes.begin(), table.phonemes.end(), phoneme),
              table.phonemes.end());
    EXPECT_EQ(std::count(table.visemes.begin(), table.visemes.end(), phoneme.viseme), 1);
  }
  EXPECT_EQ(table.emotions, (std::vector<std::string>{"happiness", "neutral"}));
  EXPECT_EQ(table.speaker, "s2");
  EXPECT_EQ(table.rate_hz, test::kRate_hz);
  EXPECT_EQ(table.phoneme_sets, std::vector<std::string>{"festival_us"});
  EXPECT_FALSE(table.synthetic);
  EXPECT_EQ(format_layout(table.layout), format_layout(test::made_layout()));
  EXPECT_EQ(table.reference_pose,
            corpus.sentences[1].channels.row(0).transpose().cast<double>().eval());
}

// An edge of the alignment counts as silence in a triphone, with or without a /pau/ row.
TEST_F(MotionTableTest, EdgesWithoutPauseHaveSilenceAsNeighbour) {
  ImportedSentence& sentence = corpus.sentences[1];
  sentence.rows.erase(sentence.rows.begin());
  sentence.rows.pop_back();
  for (ImportedNode& node : sentence.nodes) {
    --node.row;
  }
  import();
  const MotionTable table = load("s2");
  EXPECT_EQ(table.nodes.front().order, 0);
  EXPECT_EQ(table.nodes.front().previous_phoneme, 0);
  EXPECT_EQ(table.nodes.back().next_phoneme, 0);
}

// What pre(o) is, once more from the recordings: the row before, in the table, not across a pause.
TEST_F(MotionTableTest, LinksCapturedNeighboursOnly) {
  import();
  const auto prune = [&](const std::string& sentence, int row) {
    test::raw_query(path,
                    "INSERT INTO prunings SELECT id, " + std::to_string(row) +
                        ", 'ann', '2026-01-02T03:04:05Z', 'jump' FROM sentences WHERE name = '" +
                        sentence + "'");
  };
  prune("é", 3);
  const MotionTable table = load("s1");
  std::set<std::string> gone;
  for (const UnavailableNode& node : table.unavailable) {
    gone.insert(node.key);
  }
  EXPECT_EQ(gone, (std::set<std::string>{"s1/neutral/b#3", "s1/neutral/é#3"}));
  EXPECT_EQ(table.unavailable[0].reason, "has unfilled gaps");
  EXPECT_EQ(table.unavailable[1].reason, "pruned by ann on 2026-01-02: jump");
  int links = 0, pauses = 0;
  for (NodeIndex i = 0; i < table.node_count(); ++i) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(i)];
    const ImportedSentence& from =
        original(table.sentences[static_cast<std::size_t>(node.sentence)]);
    EXPECT_EQ(gone.count(table.key(i)), 0u);
    const bool before_is_pause = from.rows[static_cast<std::size_t>(node.order) - 1].is_silence();
    const bool linked = !before_is_pause && gone.count(full_key(from, node.order - 1)) == 0;
    pauses += before_is_pause && node.order > 1 ? 1 : 0;
    ASSERT_EQ(node.predecessor != kNoNode, linked) << table.key(i);
    if (linked) {
      ++links;
      EXPECT_EQ(table.key(node.predecessor), full_key(from, node.order - 1));
      EXPECT_EQ(table.nodes[static_cast<std::size_t>(node.predecessor)].successor, i);
    }
  }
  EXPECT_EQ(std::count_if(table.nodes.begin(), table.nodes.end(),
                          [](const MotionNode& node) { return node.successor != kNoNode; }),
            links);
  EXPECT_EQ(pauses, 1);
}

TEST_F(MotionTableTest, CoefficientsAreTheProjectionOfTheNodesOwnFrames) {
  import();
  const MotionTable table = load("s1");
  const PcaModel pca = made_pca(12, 5);
  EXPECT_EQ(table.pca.basis, pca.basis);
  EXPECT_EQ(table.pca.mean, pca.mean);
  EXPECT_EQ(table.pca.variance, pca.variance);
  EXPECT_EQ(table.pca.total_variance, pca.total_variance);
  for (NodeIndex i = 0; i < table.node_count(); ++i) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(i)];
    const ImportedSentence& from =
        original(table.sentences[static_cast<std::size_t>(node.sentence)]);
    const auto imported = std::find_if(from.nodes.begin(), from.nodes.end(),
                                       [&](const auto& n) { return n.row == node.order; });
    ASSERT_EQ(node.frame_count, imported->frame_count);
    for (int frame = 0; frame < node.frame_count; ++frame) {
      for (int d = 0; d < 5; ++d) {
        double sum = 0.0;
        for (int c = 0; c < 12; ++c) {
          sum +=
              (static_cast<double>(from.channels(imported->first_frame + frame, c)) - pca.mean(c)) *
              pca.basis(c, d);
        }
        ASSERT_EQ(table.node_frames(i)(frame, d), static_cast<float>(sum));
      }
    }
  }
}

// By one connection, which may write, and by several side by side.
TEST_F(MotionTableTest, IsTheSameHoweverManyThreadsRead) {
  corpus = test::made_corpus("many", 9);
  corpus.sentences[3].nodes[1].has_gap = true;
  corpus.sentences[7].nodes[2].has_gap = true;
  import();
  {
    MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
    database.curate({.action = CurationAction::prune,
                     .keys = {"many0#2", "many8#3"},
                     .by = "ann",
                     .reason = "jump"});
  }
  const auto nodes_of = [](const MotionTable& table) {
    std::vector<std::vector<std::int64_t>> nodes;
    for (const MotionNode& n : table.nodes) {
      nodes.push_back({n.phoneme, n.viseme, n.emotion, n.sentence, n.order, n.previous_phoneme,
                       n.next_phoneme, n.predecessor, n.successor, n.first_frame, n.frame_count});
    }
    return nodes;
  };
  const auto unavailable_of = [](const MotionTable& table) {
    std::vector<std::string> texts;
    for (const UnavailableNode& node : table.unavailable) {
      texts.push_back(node.key + ": " + node.reason);
    }
    return texts;
  };
  const MotionTable alone =
      MotionDatabase::open(path, OpenMode::read_write).load_motion_table("s1");
  EXPECT_EQ(unavailable_of(alone).size(), 4u);
  const int usual = omp_get_max_threads();
  for (const int threads : {1, 2, 3, 16}) {
    omp_set_num_threads(threads);
    const MotionTable table = load("s1");
    EXPECT_EQ(nodes_of(table), nodes_of(alone)) << threads;
    EXPECT_EQ(unavailable_of(table), unavailable_of(alone)) << threads;
    EXPECT_EQ(table.coefficients, alone.coefficients) << threads;
  }
  omp_set_num_threads(usual);
}

// Threads open the file by its name again.
TEST_F(MotionTableTest, IsThatOfTheFileThatWasOpenedThoughAnotherTookItsName) {
  corpus = test::made_corpus("a", 6);
  import();
  const MotionDatabase opened = MotionDatabase::open(path, OpenMode::read_only);
  const MotionTable before = opened.load_motion_table("s1");
  const std::filesystem::path first = path;
  path = folder / "other.db";
  corpus = test::made_corpus("b", 6);
  import();
  std::filesystem::rename(path, first);
  const MotionTable after = opened.load_motion_table("s1");
  EXPECT_EQ(after.coefficients, before.coefficients);
  EXPECT_NE(MotionDatabase::open(first, OpenMode::read_only).load_motion_table("s1").coefficients,
            before.coefficients);
}

TEST_F(MotionTableTest, ChannelsAndHeadPosesComeBackBitForBit) {
  import();
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  for (const ImportedSentence& sentence : corpus.sentences) {
    const SentenceInfo info{sentence.speaker, sentence.emotion, sentence.id, ""};
    EXPECT_EQ(database.load_channels(info), sentence.channels);
    const std::vector<HeadPose> head = database.load_head(info);
    ASSERT_EQ(head.size(), sentence.head.size());
    for (std::size_t i = 0; i < head.size(); ++i) {
      EXPECT_EQ(head[i].translation_mm, sentence.head[i].translation_mm);
      EXPECT_EQ(head[i].rotation.coeffs(), sentence.head[i].rotation.coeffs());
    }
  }
  EXPECT_NE(test::input_error([&] {
              database.load_channels({"s1", "neutral", "nobody", ""});
            }).find("there is no sentence s1/neutral/nobody"),
            std::string::npos);
}

TEST_F(MotionTableTest, SpeakerIsNamedUnlessThereIsOnlyOne) {
  import();
  EXPECT_NE(test::input_error([&] { load(""); }).find("(expected one of s1, s2)"),
            std::string::npos);
  EXPECT_NE(test::input_error([&] { load("s3"); }).find("there is no speaker \"s3\""),
            std::string::npos);
  MotionDatabase one = MotionDatabase::open(folder / "one.db", OpenMode::read_write);
  import_corpus(one, test::made_corpus("one", 2));
  EXPECT_EQ(one.load_motion_table("").speaker, "s1");
}

TEST_F(MotionTableTest, NodesAreListedByEveryFilter) {
  import();
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  const std::vector<NodeRecord> all = database.list_nodes({});
  const DatabaseInfo info = database.info();
  EXPECT_EQ(static_cast<std::int64_t>(all.size()), info.nodes);
  const auto expect = [&](const NodeFilter& filter, auto&& matches) {
    std::vector<std::string> expected, got;
    for (const NodeRecord& node : all) {
      if (matches(node)) {
        expected.push_back(node.key);
      }
    }
    for (const NodeRecord& node : database.list_nodes(filter)) {
      got.push_back(node.key);
    }
    EXPECT_EQ(got, expected);
    EXPECT_FALSE(got.empty());
    EXPECT_LT(got.size(), all.size());
  };
  const NodeRecord& some = all[7];
  expect({.phoneme = some.phoneme}, [&](const auto& n) { return n.phoneme == some.phoneme; });
  expect({.emotion = "happiness"}, [](const auto& n) { return n.emotion == "happiness"; });
  expect({.speaker = "s2"}, [](const auto& n) { return n.speaker == "s2"; });
  expect({.sentence = "b"}, [](const auto& n) { return n.sentence == "b"; });
  expect({.previous_phoneme = "pau"}, [](const auto& n) { return n.previous_phoneme == "pau"; });
  expect({.next_phoneme = some.next_phoneme},
         [&](const auto& n) { return n.next_phoneme == some.next_phoneme; });
  expect({.suspect = true}, [](const auto& n) { return !n.suspect.empty(); });
  expect({.suspect = false}, [](const auto& n) { return n.suspect.empty(); });
  expect({.has_gap = true}, [](const auto& n) { return n.key == "s1/neutral/b#3"; });
  EXPECT_TRUE(database.list_nodes({.pruned = true}).empty());
  const auto suspect = database.list_nodes({.suspect = true});
  ASSERT_EQ(suspect.at(0).suspect.size(), 2u);
  EXPECT_EQ(suspect.at(0).suspect[0].reason, "closed"); // in order of reason
  EXPECT_EQ(suspect.at(0).suspect[1].text, "jump: far");
  EXPECT_EQ(suspect.at(0).suspect[1].score, 3.5);
  EXPECT_DOUBLE_EQ(suspect.at(0).start_s, corpus.sentences[0].rows[2].start_s);
  EXPECT_DOUBLE_EQ(suspect.at(0).end_s, corpus.sentences[0].rows[2].end_s);
}

TEST_F(MotionTableTest, NamesThatAreNotThereAreToldWithTheirNeighbours) {
  import();
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  const auto error_of = [&](const NodeFilter& filter) {
    return test::input_error([&] { database.list_nodes(filter); });
  };
  EXPECT_EQ(error_of({.emotion = "hapiness"}),
            path.string() + ": emotion \"hapiness\" is not in this database (expected one of "
                            "happiness, neutral). Did you mean \"happiness\"?");
  for (const NodeFilter& filter :
       {NodeFilter{.phoneme = "aaa"}, NodeFilter{.previous_phoneme = "aaa"},
        NodeFilter{.next_phoneme = "aaa"}}) {
    EXPECT_NE(error_of(filter).find("phoneme \"aaa\" is not in this database"), std::string::npos);
    EXPECT_NE(error_of(filter).find("\"aa\""), std::string::npos);
  }
  EXPECT_NE(error_of({.speaker = "s3"}).find("Did you mean \"s1\" or \"s2\"?"), std::string::npos);
  EXPECT_NE(error_of({.sentence = "b' OR 1 --"}).find("sentence \"b' OR 1 --\""),
            std::string::npos);
  EXPECT_TRUE(database.list_nodes({.phoneme = "pau"}).empty()) << "known, but without nodes";
}

TEST_F(MotionTableTest, InfoCountsWhatWentIn) {
  import();
  const DatabaseInfo info = MotionDatabase::open(path, OpenMode::read_only).info();
  std::int64_t nodes = 0, frames = 0;
  std::set<std::string> triphones;
  std::map<std::string, std::int64_t> per_phoneme;
  for (const ImportedSentence& s : corpus.sentences) {
    frames += s.channels.rows();
    for (const ImportedNode& node : s.nodes) {
      const auto row = static_cast<std::size_t>(node.row);
      ++nodes;
      ++per_phoneme[s.rows[row].phoneme.name];
      triphones.insert(s.rows[row - 1].phoneme.name + s.rows[row].phoneme.name + "+" +
                       s.rows[row + 1].phoneme.name);
    }
  }
  EXPECT_EQ(info.schema_version, 4);
  EXPECT_EQ(info.sentences, 6);
  EXPECT_EQ(info.frames, frames);
  EXPECT_EQ(info.nodes, nodes);
  EXPECT_EQ(info.triphones, static_cast<std::int64_t>(triphones.size()));
  EXPECT_EQ(info.with_gaps, 1);
  EXPECT_EQ(info.suspect, 1);
  EXPECT_EQ(info.pruned, 0);
  ASSERT_EQ(info.nodes_per_phoneme.size(), per_phoneme.size());
  for (const auto& [name, count] : info.nodes_per_phoneme) {
    EXPECT_EQ(count, per_phoneme[name]) << name;
  }
  ASSERT_EQ(info.corpora.size(), 1u);
  EXPECT_EQ(info.corpora[0].sentences, 6);
  EXPECT_EQ(info.speakers, (std::vector<std::string>{"s1", "s2"}));
}

} // namespace
} // namespace phonomime
