// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/demo/support.h"
#include "tools/demo/corpus_writer.h"
#include "tools/demo/emotion_style.h"

namespace phonomime::demo {
namespace {

namespace fs = std::filesystem;

class Corpus : public testing::Test {
protected:
  Corpus() {
    job_.sentences = {{"d01", "Bob."}, {"d02", "Mama."}, {"d03", "Five."}};
    job_.speech = scratch_.path() / "speech";
    job_.out = scratch_.path() / "corpus";
    job_.face = mask_face_model();
    for (const EmotionStyle& style : emotion_styles())
      for (const Sentence& sentence : job_.sentences) {
        const fs::path folder = job_.speech / style.emotion;
        fs::create_directories(folder);
        write_file(folder / (sentence.id + ".wav"), "RIFF");
        write_file(folder / (sentence.id + ".lab"), as_lab(sequence({{"pau", 0.2},
                                                                     {"b", 0.08},
                                                                     {"aa", 0.15},
                                                                     {"b", 0.08},
                                                                     {"pau", 0.3},
                                                                     {"pau", 0.0}})));
      }
  }

  std::map<std::string, std::string> files(const fs::path& folder) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file())
        all[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
    return all;
  }

  test::TemporaryFolder scratch_;
  CorpusJob job_;
};

TEST_F(Corpus, HasEveryFileOfItsTableAndSaysThatItIsSynthetic) {
  const CorpusReport report = write_corpus(job_);
  EXPECT_EQ(report.sentences, 12);
  const auto made = files(job_.out);
  EXPECT_EQ(made.size(), 12u * 3u + 7u);
  const auto corpus = nlohmann::json::parse(made.at("corpus.json"));
  EXPECT_TRUE(corpus.at("synthetic"));
  EXPECT_EQ(corpus.at("phoneme_set"), "festival_us");
  EXPECT_NE(corpus.at("description").get<std::string>().find("synthetic"), std::string::npos);
  EXPECT_NE(made.at("sentences.tsv")
                .find("d02\tMama.\tdemo\tanger\tmotion/anger/d02.c3d\talignment/anger/d02.lab\t"
                      "audio/anger/d02.wav\n"),
            std::string::npos);
  EXPECT_EQ(made.at("alignment/anger/d02.lab"), read_file(job_.speech / "anger" / "d02.lab"));
}

TEST_F(Corpus, TwoRunsMakeTheSameBytesAndAnotherSeedOthers) {
  write_corpus(job_);
  const auto first = files(job_.out);
  write_corpus(job_);
  EXPECT_EQ(files(job_.out), first);
  job_.seed = 1;
  write_corpus(job_);
  EXPECT_NE(files(job_.out).at("motion/neutral/d01.c3d"), first.at("motion/neutral/d01.c3d"));
}

TEST_F(Corpus, OneFileInTenHoldsFloats) {
  write_corpus(job_);
  int floats = 0;
  for (const auto& [name, bytes] : files(job_.out))
    if (name.ends_with(".c3d"))
      floats += (static_cast<unsigned char>(bytes[15]) & 0x80) != 0;
  EXPECT_EQ(floats, 1);
}

TEST_F(Corpus, AFailureLeavesTheOldCorpusAndNothingElse) {
  write_corpus(job_);
  const auto before = files(job_.out);
  fs::remove(job_.speech / "sadness" / "d03.lab");
  EXPECT_THROW(write_corpus(job_), IoError);
  EXPECT_EQ(files(job_.out), before);
  write_file(job_.speech / "sadness" / "d03.lab", "#\n0.5 100 pau\n0.4 100 aa\n");
  EXPECT_THROW(write_corpus(job_), InputError);
  EXPECT_EQ(files(job_.out), before);
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(scratch_.path()))
    ++entries;
  EXPECT_EQ(entries, 2) << "speech and corpus";
}

TEST_F(Corpus, NeverReplacesAFolderOfSomethingElse) {
  fs::create_directories(job_.out);
  write_file(job_.out / "diary.txt", "dear");
  EXPECT_THROW(write_corpus(job_), InputError);
  EXPECT_EQ(files(job_.out).size(), 1u);
}

TEST(Sentences, AreReadAndChecked) {
  const auto sentences = parse_sentences("# c\n\na1\tHello there.\nb\tBye.\n", "s.txt");
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_EQ(sentences[0].id, "a1");
  EXPECT_EQ(sentences[0].text, "Hello there.");
  EXPECT_THROW(parse_sentences("a1 Hello\n", "s.txt"), InputError);
  EXPECT_THROW(parse_sentences("../a\tHello\n", "s.txt"), InputError);
  EXPECT_THROW(parse_sentences("a\tHello\na\tHello\n", "s.txt"), InputError);
  EXPECT_THROW(parse_sentences("", "s.txt"), InputError);
}

TEST(Segments, ZeroLengthRowsOfFestivalAreLeftOut) {
  const auto segments = parse_festival_segments("#\n0.5 100 pau\n0.7 100 aa\n0.7 100 pau\n", "a");
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_EQ(segments[1].phoneme, "aa");
  EXPECT_EQ(segments[1].start_s, 0.5);
  EXPECT_THROW(parse_festival_segments("#\n0.5 100 pau\n0.4 100 aa\n", "a"), InputError);
  EXPECT_THROW(parse_festival_segments("#\n", "a"), InputError);
}

} // namespace
} // namespace phonomime::demo
