// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/journal.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

namespace phonomime {
namespace {

using Description = std::map<std::string, std::string>;
const Description kRun = {{"folds", "5"}, {"seed", "1"}};
const std::string kWeights = R"({"alpha1":1.0,"alpha2":0.2})";
const std::string kOthers = R"({"alpha1":1.0,"alpha2":0.3})";

class JournalTest : public ::testing::Test {
protected:
  std::filesystem::path path() const { return folder_.path() / "journal"; }
  void write(const std::string& text) const { std::ofstream(path()) << text; }

  // Expects that the journal is refused with all of these words.
  void expect_refused(const Description& run, const std::vector<std::string>& words) const {
    try {
      const Journal journal(path(), run);
      ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
      for (const std::string& word : words) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      }
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(JournalTest, KnowsAgainWhatItWasTold) {
  // Values that have no short decimal form, and none.
  const SentenceValues values = {1.0 / 3.0, std::nullopt, 5e-324,
                                 std::numeric_limits<double>::max(), -0.1};
  {
    Journal journal(path(), kRun);
    EXPECT_EQ(journal.found(), 0u);
    EXPECT_EQ(journal.find("all", kWeights), std::nullopt);
    journal.add("all", kWeights, values);
    EXPECT_EQ(journal.find("all", kWeights), values);
  }
  const Journal again(path(), kRun);
  EXPECT_EQ(again.found(), 1u);
  EXPECT_EQ(again.find("all", kWeights), values);
  EXPECT_EQ(again.find("all", kOthers), std::nullopt);
  EXPECT_EQ(again.find("fold 1", kWeights), std::nullopt);
}

TEST_F(JournalTest, DropsALineThatWasCutOffAnywhere) {
  {
    Journal journal(path(), kRun);
    journal.add("all", kWeights, {1.5});
    journal.add("all", kOthers, {2.5});
  }
  const std::string whole = read_file(path());
  const std::size_t header = whole.find('\n') + 1;
  const std::size_t second = whole.find('\n', header) + 1;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write(whole.substr(0, size));
    {
      Journal journal(path(), kRun);
      EXPECT_EQ(journal.found(), size < second ? 0u : 1u) << size;
      journal.add("all", kWeights, {1.5});
      journal.add("all", kOthers, {2.5});
    }
    ASSERT_EQ(read_file(path()), whole) << size;
  }
}

TEST_F(JournalTest, RefusesThatOfAnotherRunAndSaysWhatDiffers) {
  { const Journal journal(path(), kRun); }
  const std::string before = read_file(path());
  expect_refused({{"folds", "5"}, {"seed", "2"}}, {"seed differs", "expected 2", "got 1"});
  expect_refused({{"folds", "5"}, {"rest", "no"}, {"seed", "1"}}, {"rest differs", "got nothing"});
  EXPECT_EQ(read_file(path()), before);
}

TEST_F(JournalTest, RefusesAFileThatIsNoJournal) {
  for (const char* text :
       {"no journal", "no journal\n", "{}\n", "[1]\n", "{\"format\":\"other\"}\n"}) {
    write(text);
    expect_refused(kRun, {"journal"});
    EXPECT_EQ(read_file(path()), text);
  }
}

TEST_F(JournalTest, SaysWhichLineIsSpoilt) {
  { const Journal journal(path(), kRun); }
  write(read_file(path()) + "{\"set\":\"all\"}\n");
  expect_refused(kRun, {"journal:2", "no evaluation"});
}

TEST_F(JournalTest, IsForOneRunAtATime) {
  const Journal journal(path(), kRun);
  EXPECT_THROW(Journal(path(), kRun), IoError);
}

TEST_F(JournalTest, WithoutAFileRemembersAsLongAsItLives) {
  Journal journal({}, kRun);
  journal.add("all", kWeights, {1.5});
  EXPECT_EQ(journal.find("all", kWeights), SentenceValues{1.5});
}

} // namespace
} // namespace phonomime
