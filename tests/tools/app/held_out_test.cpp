// SPDX-License-Identifier: GPL-3.0-or-later
//
// Nothing of held-out recordings gets into what speaks them.
#include "tools/app/held_out.h"

#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "tests/db/import/importer/corpus_folder.h"
#include "tools/app/speak_held_out.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

namespace phonomime {
namespace {

constexpr const char* kLab = "#\n0.3 100 sil\n0.55 100 B\n0.8 100 IH1\n1.1 100 N\n1.4 100 AH0\n"
                             "1.7 100 F\n2.0 100 sil\n";

// Six sentences a to f; the last two are held out.
class SixSentences {
public:
  SixSentences() {
    setenv("SOURCE_DATE_EPOCH", "0", 1); // the hour of an import is in the database
    std::string table;
    for (int i = 0; i < 6; ++i) {
      const std::string id(1, static_cast<char>('a' + i));
      folder.write(id + ".csv", test::CorpusFolder::motion(100, 0.7 * i));
      folder.write(id + ".lab", kLab);
      table += fmt::format("{0}\t{0}.csv\t{0}.lab\n", id);
    }
    folder.write_table(table);
    options.corpus = folder.corpus();
  }

  HeldOut hold_out(const std::string& database) const {
    const auto held_out = [](const CorpusSentence& sentence) { return sentence.id >= "e"; };
    return phonomime::hold_out(options, held_out, [](const CorpusSentence&) { return true; },
                               folder.outside(database), {});
  }

  // The held-out sentences get other recordings and other alignments.
  void alter() const {
    for (const std::string id : {"e", "f"}) {
      folder.write(id + ".csv", test::CorpusFolder::motion(140, 40.0));
      folder.write(id + ".lab", "#\n0.5 100 sil\n1.5 100 OW1\n2.0 100 M\n2.8 100 sil\n");
    }
  }

  // A database's bytes, but the counter of how often the file was taken in hand.
  std::string bytes(const std::string& database) const {
    std::string read = read_file(folder.outside(database));
    for (const std::size_t place : {24u, 92u}) {
      read.replace(place, 4, 4, '\0');
    }
    return read;
  }

  test::CorpusFolder folder;
  ImportOptions options;
};

TEST(HeldOut, IsReadAsAnImportWouldReadIt) {
  const SixSentences corpus;
  const HeldOut held_out = corpus.hold_out("fold.db");
  ASSERT_EQ(held_out.sentences.size(), 2u);
  EXPECT_EQ(held_out.sentences[0].id, "e");
  EXPECT_EQ(held_out.sentences[1].id, "f");
  EXPECT_TRUE(held_out.notes.empty());
  const MotionTable& table = held_out.tables.at("small");
  EXPECT_EQ(table.sentences.size(), 4u);
  // Into the fold's own database they go with its pose and rate, to the bit.
  ImportOptions add = corpus.options;
  add.database = corpus.folder.outside("fold.db");
  add.takes = [](const CorpusSentence& sentence) { return sentence.id >= "e"; };
  import_corpus(add, {});
  const MotionDatabase database = MotionDatabase::open(add.database, OpenMode::read_only);
  for (const ImportedSentence& sentence : held_out.sentences) {
    EXPECT_EQ(database.load_channels({sentence.speaker, sentence.emotion, sentence.id, ""}),
              sentence.channels);
  }
}

TEST(HeldOut, AlteringItsRecordingsChangesNoByteOfTheDatabaseAndNoneOfItsPca) {
  const SixSentences corpus;
  const HeldOut before = corpus.hold_out("before.db");
  corpus.alter();
  const HeldOut after = corpus.hold_out("after.db");
  ASSERT_NE(before.sentences[0].channels.rows(), after.sentences[0].channels.rows());
  EXPECT_TRUE(corpus.bytes("before.db") == corpus.bytes("after.db")); // too long to be printed
  const MotionTable& ours = before.tables.at("small");
  const MotionTable& theirs = after.tables.at("small");
  EXPECT_EQ(ours.pca.mean, theirs.pca.mean);
  EXPECT_EQ(ours.pca.basis, theirs.pca.basis);
  EXPECT_EQ(ours.reference_pose, theirs.reference_pose);
  EXPECT_EQ(ours.coefficients, theirs.coefficients);
}

TEST(HeldOut, AlteringATrainingRecordingIsSeen) {
  const SixSentences corpus;
  corpus.hold_out("before.db");
  corpus.folder.write("b.csv", test::CorpusFolder::motion(100, 40.0));
  corpus.hold_out("after.db");
  EXPECT_FALSE(corpus.bytes("before.db") == corpus.bytes("after.db"));
}

TEST(HeldOut, AReferenceFrameInAHeldOutSentenceIsNotLookedAt) {
  const SixSentences corpus;
  const auto name_frame = [&](const std::string& sentence) {
    corpus.folder.write("corpus.json", R"({"format": "phonomime-corpus", "version": 1,
      "name": "small", "phoneme_set": "arpabet", "layout": "layout.json",
      "sentences": "sentences.tsv", "reference_frame": {"sentence": ")" +
                                           sentence + R"(", "time": 0.1}})");
  };
  const Eigen::VectorXd unnamed = corpus.hold_out("unnamed.db").tables.at("small").reference_pose;
  name_frame("f");
  const HeldOut named = corpus.hold_out("held_out.db");
  EXPECT_EQ(named.tables.at("small").reference_pose, unnamed);
  name_frame("c");
  EXPECT_NE(corpus.hold_out("training.db").tables.at("small").reference_pose, unnamed);
}

TEST(HeldOut, NoMethodButTheOracleAnswersOtherwiseWhenARecordingIsAltered) {
  const SixSentences corpus;
  HeldOut held_out = corpus.hold_out("fold.db");
  SynthOptions options;
  const std::vector<MethodEntry> methods = find_methods({});
  const auto speak = [&] {
    std::vector<SpokenSentence> spoken(held_out.sentences.size());
    speak_held_out(held_out.tables, held_out.sentences, methods, options, {},
                   [&](std::size_t i, SpokenSentence&& one) { spoken[i] = std::move(one); });
    return spoken;
  };
  const std::vector<SpokenSentence> before = speak();
  for (ImportedSentence& sentence : held_out.sentences) {
    sentence.channels.array() = 1.3f * sentence.channels.array() + 2.0f;
  }
  const std::vector<SpokenSentence> after = speak();
  options.threads = 1;
  const std::vector<SpokenSentence> alone = speak();
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      if (!methods[m].sees_recording) {
        EXPECT_EQ(before[i].synthesised[m].channels, after[i].synthesised[m].channels)
            << methods[m].name;
      }
      EXPECT_EQ(alone[i].synthesised[m].channels, after[i].synthesised[m].channels)
          << methods[m].name;
    }
  }
}

} // namespace
} // namespace phonomime
