// SPDX-License-Identifier: GPL-3.0-or-later
// The scripts that ask Festival, end to end.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "db/types/file_io.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/demo/support.h"
#include "tools/demo/articulation.h"
#include "tools/demo/corpus_writer.h"
#include "tools/demo/dominance.h"
#include "tools/demo/emotion_style.h"

#define PHONOMIME_NEEDS_FESTIVAL()                                                                 \
  if (!has_program("festival"))                                                                    \
  GTEST_SKIP() << "Festival is not installed"

namespace phonomime::demo {
namespace {

namespace fs = std::filesystem;

const std::string kTools = PHONOMIME_SOURCE_DIR "/tools/demo";

std::string speak(const std::string& text, const fs::path& prefix) {
  return shell_quoted(kTools + "/speak") + " " + shell_quoted(text) + " " +
         shell_quoted(prefix.string());
}

// Length of a RIFF file of 16-bit mono samples, from its bytes.
double wave_seconds(const std::string& bytes) {
  const auto number = [&](std::size_t at) {
    double value = 0.0;
    for (int i = 3; i >= 0; --i)
      value = 256.0 * value + static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
  };
  return static_cast<double>(bytes.size() - 44) / (2.0 * number(24));
}

TEST(Speech, SpeakLeavesAWaveAndItsSegments) {
  PHONOMIME_NEEDS_FESTIVAL();
  const test::TemporaryFolder folder;
  const CommandResult result = run(speak("Bob's \"maple\" map.", folder.path() / "new dir" / "a"));
  ASSERT_EQ(result.status, 0) << result.output;
  const auto segments =
      parse_festival_segments(read_file(folder.path() / "new dir" / "a.lab"), "a.lab");
  EXPECT_EQ(segments.front().phoneme, "pau");
  EXPECT_EQ(segments[1].phoneme, "b");
  EXPECT_NEAR(wave_seconds(read_file(folder.path() / "new dir" / "a.wav")), segments.back().end_s,
              0.01);
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path() / "new dir"))
    ++entries;
  EXPECT_EQ(entries, 2);
}

TEST(Speech, TextIsNeverRun) {
  PHONOMIME_NEEDS_FESTIVAL();
  const test::TemporaryFolder folder;
  const std::string mark = (folder.path() / "mark").string();
  for (const std::string& text :
       {"one\") (system \"touch " + mark + "\") (quit \"",
        "one\\\") (system \"touch " + mark + "\")",
        "one $(touch " + mark + ") `touch " + mark + "`", std::string("one '; exit 9; ' two\\")}) {
    const CommandResult result = run(speak(text, folder.path() / "a"));
    EXPECT_EQ(result.status, 0) << text << ": " << result.output;
    const auto segments = parse_festival_segments(read_file(folder.path() / "a.lab"), "a.lab");
    EXPECT_EQ(segments[1].phoneme, "w") << text;
    EXPECT_FALSE(fs::exists(mark)) << text;
    fs::remove(folder.path() / "a.lab");
  }
}

TEST(Speech, RefusesWhatCannotBeSpoken) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(run(speak(" ?! ", folder.path() / "a")).status, 3);
  EXPECT_EQ(run(speak(std::string(3000, 'a'), folder.path() / "a")).status, 3);
  EXPECT_EQ(run(shell_quoted(kTools + "/speak")).status, 2);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Speech, MissingFestivalIsNamedWithItsPackages) {
  const test::TemporaryFolder folder;
  const std::string bash = run("command -v bash").output;
  const std::string start =
      "PATH=" + shell_quoted(folder.path().string()) + " " + bash.substr(0, bash.find('\n')) + " ";
  const std::string speak_command = start + speak("Hello.", folder.path() / "a");
  const std::string make_command = start + shell_quoted(kTools + "/make_demo_corpus") +
                                   " --program " + shell_quoted(PHONOMIME_DEMO_CORPUS) + " " +
                                   shell_quoted((folder.path() / "corpus").string());
  for (const std::string& command : {speak_command, make_command}) {
    const CommandResult result = run(command);
    EXPECT_EQ(result.status, 4) << result.output;
    EXPECT_NE(result.output.find("apt-get install festival festlex-cmu festvox-us-slt-hts"),
              std::string::npos)
        << result.output;
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

// Festival's lexicon alone, without the voice's waves, says which phonemes the sentences have.
TEST(Speech, SentencesHoldEveryPhonemeAtLeastFourTimes) {
  PHONOMIME_NEEDS_FESTIVAL();
  const test::TemporaryFolder folder;
  std::string scheme = "(voice_cmu_us_slt_arctic_hts)\n";
  const auto sentences = parse_sentences(read_file(kTools + "/sentences.txt"), "sentences.txt");
  EXPECT_GE(sentences.size(), 40u);
  for (const Sentence& sentence : sentences) {
    ASSERT_EQ(sentence.text.find_first_of("\"\\"), std::string::npos);
    scheme += "(let ((u (Utterance Text \"" + sentence.text + "\")))\n";
    for (const char* step : {"Initialize", "Text", "Token_POS", "Token", "POS", "Phrasify", "Word",
                             "Pauses", "Intonation", "PostLex"})
      scheme += std::string("(") + step + " u)";
    scheme += "(mapcar (lambda (s) (format t \"%s\\n\" (item.name s)))"
              " (utt.relation.items u 'Segment)))\n";
  }
  write_file(folder.path() / "a.scm", scheme);
  const CommandResult result = run("festival -b " + (folder.path() / "a.scm").string());
  ASSERT_EQ(result.status, 0) << result.output;
  std::map<std::string, int> counts;
  std::string word;
  for (const char c : result.output) {
    if (c != '\n') {
      word += c;
      continue;
    }
    ++counts[word];
    word.clear();
  }
  for (const PhonemeArticulation& entry : articulations())
    EXPECT_GE(counts[std::string(entry.phoneme)], 4) << entry.phoneme;
  for (const auto& [phoneme, count] : counts)
    EXPECT_NO_THROW(articulation_of(phoneme)) << count;
}

TEST(Speech, MakesACorpusWhoseLipsCloseInTheFiles) {
  PHONOMIME_NEEDS_FESTIVAL();
  if (!has_program("python3"))
    GTEST_SKIP() << "python3 is not installed";
  const test::TemporaryFolder folder;
  write_file(folder.path() / "list.txt", "m1\tMap a pool.\n");
  const fs::path corpus = folder.path() / "corpus";
  const CommandResult result = run(
      shell_quoted(kTools + "/make_demo_corpus") + " --mask --program " +
      shell_quoted(PHONOMIME_DEMO_CORPUS) + " --sentences " +
      shell_quoted((folder.path() / "list.txt").string()) + " " + shell_quoted(corpus.string()));
  ASSERT_EQ(result.status, 0) << result.output;
  for (const EmotionStyle& style : emotion_styles()) {
    const std::string name = std::string(style.emotion) + "/m1";
    const auto segments =
        parse_festival_segments(read_file(corpus / "alignment" / (name + ".lab")), name);
    EXPECT_NEAR(wave_seconds(read_file(corpus / "audio" / (name + ".wav"))), segments.back().end_s,
                0.01);
    const ReadC3d c3d = read_with_python(corpus / "motion" / (name + ".c3d"));
    EXPECT_EQ(c3d.frames, frame_count(segments.back().end_s, c3d.rate_hz));
    std::map<long, double> upper;
    std::map<long, double> lower;
    for (const ReadPoint& point : c3d.points) {
      if (point.name == "lm13")
        upper[point.frame] = point.xyz_mm[1];
      if (point.name == "lm14")
        lower[point.frame] = point.xyz_mm[1];
    }
    double widest = 0.0;
    int closures = 0;
    for (const auto& [frame, y] : upper)
      widest = std::max(widest, y - lower[frame]);
    EXPECT_GT(widest, 4.0);
    for (const Segment& s : segments) {
      if (articulation_of(s.phoneme).contact != Contact::lips)
        continue;
      ++closures;
      const long middle = std::lround(0.5 * (s.start_s + s.end_s) * c3d.rate_hz);
      EXPECT_LT(std::abs(upper[middle] - lower[middle]), 0.5) << name << " " << s.phoneme;
    }
    EXPECT_EQ(closures, 3);
  }
}

} // namespace
} // namespace phonomime::demo
