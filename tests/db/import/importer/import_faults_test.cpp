// SPDX-License-Identifier: GPL-3.0-or-later
// Bad input: one clear error each, and the database as it was.
#include "tools/app/import_corpus.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/db/import/importer/corpus_folder.h"

#include <gtest/gtest.h>

#include <functional>

namespace phonomime {
namespace {

struct Fault {
  const char* name;
  std::function<void(const test::CorpusFolder&)> spoil;
  const char* message; // a part of it
  bool found_before_writing = true;
};

std::string without_marker(const std::string& csv, bool all) {
  std::istringstream lines(csv);
  std::string result;
  std::string line;
  std::getline(lines, line);
  result = line + '\n';
  while (std::getline(lines, line)) {
    if (all) {
      line = line.substr(0, line.find(','));
      for (int i = 0; i < 18; ++i) {
        line += ",nan";
      }
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        line.erase(line.rfind(','));
      }
      line += ",nan,nan,nan";
    }
    result += line + '\n';
  }
  return result;
}

const Fault kFaults[] = {
    {"AlignmentLonger", [](const auto& f) { f.write("b.lab", f.alignment(2.2)); },
     "sentences.tsv:3: alignment \"b.lab\" is longer than its motion \"b.csv\" (expected 2 s to "
     "within 0.1 s, got 2.2 s). Check that both are of the same recording, or allow for more with "
     "--tolerance."},
    {"AlignmentShorter", [](const auto& f) { f.write("b.lab", f.alignment(1.75)); },
     "alignment \"b.lab\" is shorter than its motion \"b.csv\" (expected 2 s to within 0.1 s, got "
     "1.75 s). Check that both are of the same recording; end the alignment with a row of silence, "
     "or allow for more with --tolerance."},
    {"UnknownPhoneme",
     [](const auto& f) { f.write("b.lab", "#\n0.3 100 sil\n0.5 100 axx\n2.0 100 sil\n"); },
     "\"axx\""},
    {"RepeatedTriple", [](const auto& f) { f.write_table("c\ta.csv\ta.lab\nc\tb.csv\tb.lab\n"); },
     "small/neutral/c is there twice, first at line 2"},
    {"InTheDatabaseAlready", [](const auto& f) { f.write_table("a\ta.csv\ta.lab\n"); },
     "sentence small/neutral/a is in the database already"},
    {"PathUp", [](const auto& f) { f.write_table("c\t../a.csv\ta.lab\n"); }, "holds \"..\""},
    {"PathAbsolute", [](const auto& f) { f.write_table("c\t/etc/passwd\ta.lab\n"); },
     "is absolute"},
    {"PathByLink",
     [](const auto& f) {
       std::ofstream(f.outside("x.csv")) << f.motion(100, 0.0);
       std::filesystem::create_symlink(f.outside("x.csv"), f.corpus() / "x.csv");
       f.write_table("c\tx.csv\ta.lab\n");
     },
     "leads out of the corpus folder"},
    {"MarkerMissingThroughout",
     [](const auto& f) { f.write("b.csv", without_marker(f.read("b.csv"), false)); },
     "1 of 6 groups missing throughout the motion of sentence \"d\": \"lower\""},
    {"AllMarkersMissingThroughout",
     [](const auto& f) { f.write("b.csv", without_marker(f.read("b.csv"), true)); },
     "all of 6 groups missing throughout"},
    {"TableNotUtf8", [](const auto& f) { f.write_table("\xC3\x28\ta.csv\ta.lab\n"); },
     "sentences.tsv:2: line is not UTF-8"},
    {"ColumnMissing", [](const auto& f) { f.write("sentences.tsv", "id\tmotion\nc\ta.csv\n"); },
     "column \"alignment\" is missing"},
    {"NotAPhonemeSet",
     [](const auto& f) {
       std::string text = f.read("corpus.json");
       text.replace(text.find("arpabet"), 7, "arpabat");
       f.write("corpus.json", text);
     },
     "Did you mean \"arpabet\"?"},
    {"TooManyPhonemes",
     [](const auto& f) {
       std::string text = "#\n";
       for (int i = 1; i <= 1000; ++i) {
         text += fmt::format("{:.4f} 100 T\n", 0.002 * i);
       }
       f.write("b.lab", text);
     },
     "more phonemes than there are frames", false},
};

// What a person can see of a database: its corpora and its nodes with their keys.
std::vector<std::string> content_of(const std::filesystem::path& path) {
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  std::vector<std::string> content;
  for (const CorpusRecord& corpus : database.info().corpora) {
    content.push_back(corpus.name + corpus.imported_at + corpus.report_json);
  }
  for (const NodeRecord& node : database.list_nodes({})) {
    content.push_back(node.key);
  }
  return content;
}

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

class ImportFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(ImportFaults, OneClearErrorAndTheDatabaseAsItWas) {
  const test::CorpusFolder folder;
  ImportOptions options;
  options.corpus = folder.corpus();
  options.database = folder.database();
  import_corpus(options, {});
  const std::string bytes_before = read_file(folder.database());
  const std::vector<std::string> before = content_of(folder.database());
  // Other ids, so that only the fault is in the way.
  folder.write_table("c\ta.csv\ta.lab\nd\tb.csv\tb.lab\n");
  GetParam().spoil(folder);
  std::string message;
  try {
    import_corpus(options, {});
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_EQ(content_of(folder.database()), before);
  if (GetParam().found_before_writing) {
    EXPECT_TRUE(read_file(folder.database()) == bytes_before);
  }
  options.database += ".new";
  if (GetParam().name != std::string_view("InTheDatabaseAlready")) {
    EXPECT_THROW(import_corpus(options, {}), InputError);
    EXPECT_FALSE(std::filesystem::exists(options.database));
  }
}

INSTANTIATE_TEST_SUITE_P(Each, ImportFaults, ::testing::ValuesIn(kFaults),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(ImportFaults, AnAlignmentWithinTheToleranceIsTaken) {
  const test::CorpusFolder folder;
  folder.write("a.lab", test::CorpusFolder::alignment(2.08));
  folder.write("b.lab", test::CorpusFolder::alignment(1.92));
  ImportOptions options;
  options.corpus = folder.corpus();
  options.database = folder.database();
  const ImportReport report = import_corpus(options, {});
  EXPECT_EQ(report.frames, 208 + 200);
  EXPECT_EQ(report.held_frames, (208 - 199) + 1);
}

} // namespace
} // namespace phonomime
