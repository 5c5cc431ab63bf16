// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/file_io.h"

#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

namespace fs = std::filesystem;

class FileIo : public testing::Test {
protected:
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      found.push_back(entry.path().filename().string());
    }
    std::ranges::sort(found);
    return found;
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

using Names = std::vector<std::string>;

// A disk that is full after `bytes`: the same failure of write(), without a disk to fill.
class FullDisk {
public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }

private:
  rlimit before_{};
};

TEST_F(FileIo, BytesComeBackAsTheyWere) {
  std::string bytes(300000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(i * i >> 3);
  }
  write_file(folder_ / "a", bytes);
  EXPECT_EQ(read_file(folder_ / "a"), bytes);
  write_file(folder_ / "a", "");
  EXPECT_EQ(read_file(folder_ / "a"), "");
  EXPECT_EQ(names(), Names{"a"});
}

TEST_F(FileIo, ReadingRefusesWhatItShould) {
  EXPECT_THROW(read_file(folder_ / "none"), IoError);
  EXPECT_THROW(read_file(folder_), InputError);
  write_file(folder_ / "a", "12345");
  EXPECT_EQ(read_file(folder_ / "a", 5), "12345");
  EXPECT_NE(test::input_error([&] { read_file(folder_ / "a", 4); }).find("at most 4 bytes"),
            std::string::npos);
}

TEST_F(FileIo, NothingAppearsBeforeCommit) {
  OutputFiles files;
  files.stage(folder_ / "a", "new a");
  files.stage(folder_ / "b", "new b");
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  EXPECT_FALSE(fs::exists(folder_ / "b"));
  files.commit();
  EXPECT_EQ(names(), (Names{"a", "b"}));
  EXPECT_EQ(read_file(folder_ / "b"), "new b");
}

TEST_F(FileIo, FailureOfOneLeavesAllAsTheyWere) {
  write_file(folder_ / "a", "old a");
  {
    OutputFiles files;
    files.stage(folder_ / "a", "new a");
    EXPECT_THROW(files.stage(folder_ / "no folder" / "b", "new b"), IoError);
  }
  EXPECT_EQ(names(), Names{"a"});
  EXPECT_EQ(read_file(folder_ / "a"), "old a");
}

TEST_F(FileIo, ATargetThatBecameAFolderStopsAllOfThem) {
  write_file(folder_ / "a", "old a");
  {
    OutputFiles files;
    files.stage(folder_ / "a", "new a");
    files.stage(folder_ / "b", "new b");
    fs::create_directory(folder_ / "b");
    EXPECT_THROW(files.commit(), IoError);
  }
  EXPECT_EQ(names(), (Names{"a", "b"}));
  EXPECT_EQ(read_file(folder_ / "a"), "old a");
}

TEST_F(FileIo, AFullDiskLeavesTheOldFile) {
  write_file(folder_ / "a", "old a");
  {
    const FullDisk full(1000);
    EXPECT_THROW(write_file(folder_ / "a", std::string(100000, 'x')), IoError);
  }
  EXPECT_EQ(names(), Names{"a"});
  EXPECT_EQ(read_file(folder_ / "a"), "old a");
}

TEST_F(FileIo, AReadOnlyFolderIsAnError) {
  constexpr uid_t kNobody = 65534;
  const uid_t user = ::geteuid();
  const fs::perms read_only = fs::perms::owner_read | fs::perms::owner_exec |
                              fs::perms::others_read | fs::perms::others_exec;
  fs::permissions(folder_, read_only);
  if (user == 0 && ::seteuid(kNobody) != 0) { // root may write everywhere
    GTEST_SKIP() << "skipped: cannot stop being root";
  }
  EXPECT_THROW(write_file(folder_ / "a", "x"), IoError);
  ASSERT_TRUE(user != 0 || ::seteuid(user) == 0);
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_EQ(names(), Names{});
}

TEST_F(FileIo, DevicesAndFoldersAreNotReplaced) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(write_file(folder_ / "pipe", "x"), IoError);
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
  EXPECT_THROW(write_file(folder_, "x"), IoError);
}

TEST_F(FileIo, PermissionsAreThoseOfTheUsersMask) {
  const mode_t mask = ::umask(027);
  write_file(folder_ / "a", "x");
  ::umask(mask);
  EXPECT_EQ(fs::status(folder_ / "a").permissions(), fs::perms(0640));
}

} // namespace
} // namespace phonomime
