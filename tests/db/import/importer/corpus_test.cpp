// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/corpus.h"

#include "db/import/sentence_table.h"
#include "db/types/errors.h"
#include "tests/db/import/importer/corpus_folder.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

std::string table_error(std::string_view table) {
  return test::input_error([&] { parse_sentence_table(table, "s.tsv", "someone"); });
}

TEST(SentenceTable, IsReadWhateverItsLineEndsMarkAndOrderOfColumns) {
  const std::vector<SentenceRow> rows =
      parse_sentence_table("\xEF\xBB\xBF"
                           "alignment\tid\tmotion\temotion\tstart\tend\taudio\r\n"
                           "a.lab\ts1\tm.c3d\t\t0.5\t1.25\tx.wav\r\n"
                           "\r\n"
                           "b.lab\ts1\tm.c3d\tanger\r\n",
                           "s.tsv", "someone");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].id, "s1");
  EXPECT_EQ(rows[0].speaker, "someone");
  EXPECT_EQ(rows[0].emotion, "neutral");
  EXPECT_EQ(rows[0].start_s, 0.5);
  EXPECT_EQ(rows[0].end_s, 1.25);
  EXPECT_EQ(rows[0].audio, "x.wav");
  EXPECT_EQ(rows[0].line, 2);
  EXPECT_EQ(rows[1].emotion, "anger");
  EXPECT_EQ(rows[1].line, 4);
  EXPECT_FALSE(rows[1].start_s);
}

TEST(SentenceTable, EachFaultIsNamedWithItsLine) {
  const std::string head = "id\tmotion\talignment\tstart\tend\n";
  EXPECT_EQ(table_error(head + "a\tm\tl\nb\tm\tl\na\tm2\tl2\n"),
            "s.tsv:4: sentence someone/neutral/a is there twice, first at line 2. Give each "
            "sentence of a speaker and an emotion an id of its own.");
  EXPECT_NE(table_error("id\tmotion\n").find("s.tsv:1: column \"alignment\" is missing"),
            std::string::npos);
  EXPECT_NE(table_error("id\tmotion\talignment\temotoin\n").find("Did you mean \"emotion\""),
            std::string::npos);
  EXPECT_NE(table_error("id\tid\tmotion\talignment\n").find("twice"), std::string::npos);
  EXPECT_NE(table_error(head + "a\tm\n").find("s.tsv:2: alignment is empty"), std::string::npos);
  EXPECT_NE(table_error(head + "a\tm\tl\t1\t2\t3\n").find("more fields"), std::string::npos);
  EXPECT_NE(table_error(head + "a\tm\tl\tnan\t2\n").find("start is not a time"), std::string::npos);
  EXPECT_NE(table_error(head + "a\tm\tl\t2\t1\n").find("ends before it starts"), std::string::npos);
  EXPECT_NE(table_error(head + "a\xFF\tm\tl\n").find("s.tsv:2: line is not UTF-8"),
            std::string::npos);
  EXPECT_NE(table_error(head).find("no sentences"), std::string::npos);
  EXPECT_NE(table_error("").find("no header line"), std::string::npos);
  for (const char* id : {"a/b", "a#b", "a b"}) {
    EXPECT_NE(table_error(head + id + "\tm\tl\n").find("cannot stand in a node's key"),
              std::string::npos)
        << id;
  }
}

TEST(Corpus, IsReadWithItsFilesFound) {
  const test::CorpusFolder folder;
  const Corpus corpus = read_corpus(folder.corpus());
  EXPECT_EQ(corpus.name, "small");
  EXPECT_EQ(corpus.layout.group_count(), 6);
  ASSERT_EQ(corpus.sentences.size(), 2u);
  EXPECT_EQ(corpus.sentences[1].motion, folder.corpus() / "b.csv");
  EXPECT_EQ(corpus.sentences[1].speaker, "small");
  EXPECT_EQ(corpus.sentences[1].where, "sentences.tsv:3");
  EXPECT_TRUE(corpus.reference_frames.empty());
}

TEST(Corpus, APathThatLeavesTheFolderIsRefused) {
  const test::CorpusFolder folder;
  std::ofstream(folder.outside("secret.csv")) << test::CorpusFolder::motion(100, 0.0);
  std::filesystem::create_symlink(folder.outside("secret.csv"), folder.corpus() / "link.csv");
  std::filesystem::create_directory_symlink(folder.corpus() / "..", folder.corpus() / "up");
  std::filesystem::create_symlink("a.csv", folder.corpus() / "inner.csv");
  const auto error_of = [&](const std::string& path) -> std::string {
    folder.write_table("a\ta.csv\ta.lab\nb\t" + path + "\tb.lab\n");
    try {
      read_corpus(folder.corpus());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(error_of("../secret.csv").find("sentences.tsv:3: path \"../secret.csv\" holds \"..\""),
            std::string::npos);
  EXPECT_NE(error_of("x/../a.csv").find("holds \"..\""), std::string::npos);
  EXPECT_NE(error_of((folder.corpus() / "a.csv").string()).find("is absolute"), std::string::npos);
  EXPECT_NE(error_of("link.csv").find("leads out"), std::string::npos);
  EXPECT_NE(error_of("up/secret.csv").find("leads out"), std::string::npos);
  EXPECT_THROW(error_of("none.csv"), IoError);
  EXPECT_NE(error_of(".").find("is not a file"), std::string::npos);
  EXPECT_EQ(error_of("inner.csv"), "");
  EXPECT_EQ(error_of("./a.csv"), "");
}

TEST(Corpus, ReferenceFramesAreFoundBySpeaker) {
  const test::CorpusFolder folder;
  const auto write = [&](std::string_view reference) {
    folder.write("corpus.json",
                 fmt::format(R"({{"format": "phonomime-corpus", "version": 1, "name": "small",
                   "phoneme_set": "arpabet", "layout": "layout.json",
                   "sentences": "sentences.tsv", "reference_frame": {}}})",
                             reference));
  };
  write(R"({"sentence": "b", "time": 0.1})");
  const Corpus corpus = read_corpus(folder.corpus());
  EXPECT_EQ(corpus.reference_frames.at("small").sentence, 1u);
  EXPECT_EQ(corpus.reference_frames.at("small").time_s, 0.1);
  write(R"([{"sentence": "b", "time": 0.1}, {"sentence": "a", "time": 0.1}])");
  EXPECT_THROW(read_corpus(folder.corpus()), InputError);
  write(R"({"sentence": "c", "time": 0.1})");
  EXPECT_THROW(read_corpus(folder.corpus()), InputError);
  write(R"({"sentence": "b", "time": -1})");
  EXPECT_THROW(read_corpus(folder.corpus()), InputError);
}

} // namespace
} // namespace phonomime
