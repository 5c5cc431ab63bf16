// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/batch_record.h"

#include "db/types/file_io.h"
#include "tests/support/temporary_folder.h"
#include "tools/app/sha256.h"

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

namespace fs = std::filesystem;

class BatchRecordTest : public ::testing::Test {
protected:
  void SetUp() override {
    fs::create_directories(folder_ / "out/sub");
    write_file(outputs_[0], "motion");
    write_file(outputs_[1], "mesh");
    write_record(outputs_, "f1");
  }

  bool done() const { return is_done(outputs_, "f1"); }

  test::TemporaryFolder folder_;
  std::vector<fs::path> outputs_ = {folder_ / "out/a.csv", folder_ / "out/sub/a.glb"};
};

TEST_F(BatchRecordTest, ARowIsDoneWhileFingerprintAndOutputsAreTheSame) {
  EXPECT_TRUE(done());
  EXPECT_FALSE(is_done(outputs_, "f2"));
  EXPECT_FALSE(is_done(std::vector{outputs_[0]}, "f1"));
  EXPECT_FALSE(is_done(std::vector{outputs_[1], outputs_[0]}, "f1"));
  write_file(outputs_[1], "mosh");
  EXPECT_FALSE(done());
  write_file(outputs_[1], "mesh");
  EXPECT_TRUE(done()) << "written later, but the same";
  fs::remove(outputs_[0]);
  EXPECT_FALSE(done());
}

TEST_F(BatchRecordTest, AnOutputOfTheRecordedSizeAndTimeIsNotReadAgain) {
  const fs::file_time_type time = fs::last_write_time(outputs_[1]);
  write_file(outputs_[1], "mosh");
  fs::last_write_time(outputs_[1], time);
  EXPECT_TRUE(done());
  write_file(outputs_[1], "mesh and more");
  fs::last_write_time(outputs_[1], time);
  EXPECT_FALSE(done());
}

TEST_F(BatchRecordTest, AFolderOfResultsCanMoveAndBeNamedInAnotherWay) {
  fs::rename(folder_ / "out", folder_ / "elsewhere");
  EXPECT_TRUE(
      is_done(std::vector{folder_ / "elsewhere/a.csv", folder_ / "elsewhere/sub/a.glb"}, "f1"));
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "elsewhere/sub");
  EXPECT_TRUE(is_done(std::vector<fs::path>{"../a.csv", "a.glb"}, "f1"));
  fs::current_path(before);
}

TEST_F(BatchRecordTest, ADamagedRecordSaysThatNothingIsDone) {
  const fs::path record = record_path(outputs_);
  const std::string whole = read_file(record);
  for (const std::string& damaged :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"), std::string("7"),
        std::string("{\"fingerprint\": 1}"), std::string("{\"fingerprint\": \"f1\"}"),
        std::regex_replace(whole, std::regex("\"outputs\""), "\"others\""),
        std::regex_replace(whole, std::regex("\"version\": 1"), "\"version\": 2"),
        std::regex_replace(whole, std::regex("a.glb"), "b.glb"),
        std::regex_replace(whole, std::regex("\"bytes\": 6"), "\"bytes\": 7")}) {
    ASSERT_NE(damaged, whole);
    write_file(record, damaged);
    EXPECT_FALSE(done()) << damaged;
  }
  write_file(record, whole);
  EXPECT_TRUE(done());
}

TEST_F(BatchRecordTest, OnlyUnfinishedOutputsOfTheseRowsAreRemoved) {
  // As a killed program leaves them: the files of OutputFiles without its destructor.
  std::vector<std::string> before;
  {
    OutputFiles files;
    files.stage(outputs_[0], "half");
    files.stage(outputs_[1], "half");
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
      if (entry.path().string().find(".part-") != std::string::npos) {
        fs::copy(entry.path(), entry.path().string() + "7"); // another number at the end
        before.push_back(entry.path().string() + "7");
      }
    }
  }
  ASSERT_EQ(before.size(), 2u);
  const std::vector<fs::path> others = {folder_ / "out/b.csv.part-1-0",
                                        folder_ / "out/a.csv.part-x-0", folder_ / "out/a.csv.part"};
  for (const fs::path& other : others) {
    write_file(other, "");
  }
  remove_unfinished(outputs_);
  for (const std::string& unfinished : before) {
    EXPECT_FALSE(fs::exists(unfinished)) << unfinished;
  }
  for (const fs::path& other : others) {
    EXPECT_TRUE(fs::exists(other)) << other;
  }
  EXPECT_TRUE(done());
  EXPECT_NO_THROW(remove_unfinished(std::vector{folder_ / "nowhere/a.csv"}));
}

TEST(Sha256, IsThatOfTheStandard) { // FIPS 180-2, appendix B
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  Sha256 digest;
  for (int i = 0; i < 1000; ++i) {
    digest.add(std::string(1000, 'a'));
  }
  EXPECT_EQ(digest.hex(), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

} // namespace
} // namespace phonomime
