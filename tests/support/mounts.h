// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/statvfs.h>

namespace phonomime::test {

// A folder on a small file system of its own, or one that is mounted read-only. False where this
// process may not mount.
class Mount {
public:
  static Mount small_disk(const std::filesystem::path& folder, const std::string& size) {
    std::filesystem::create_directory(folder);
    const bool done = mount("tmpfs", folder.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
    return Mount(folder, done, done);
  }
  static Mount read_only(const std::filesystem::path& folder) {
    const bool bound = mount(folder.c_str(), folder.c_str(), nullptr, MS_BIND, nullptr) == 0;
    struct statvfs now = {};
    statvfs(folder.c_str(), &now); // a namespace's root may not take these flags off again
    const unsigned long kept =
        now.f_flag & (MS_NOSUID | MS_NODEV | MS_NOEXEC | MS_NOATIME | MS_NODIRATIME);
    const bool done = bound && mount(nullptr, folder.c_str(), nullptr,
                                     MS_BIND | MS_REMOUNT | MS_RDONLY | kept, nullptr) == 0;
    return Mount(folder, bound, done);
  }
  Mount(const Mount&) = delete;
  Mount& operator=(const Mount&) = delete;
  ~Mount() {
    if (mounted_) {
      umount2(folder_.c_str(), MNT_DETACH);
    }
  }
  explicit operator bool() const { return done_; }

private:
  Mount(const std::filesystem::path& folder, bool mounted, bool done)
      : folder_(folder), mounted_(mounted), done_(done) {}

  std::filesystem::path folder_;
  bool mounted_ = false, done_ = false;
};

// The running test once more, in a process that is root of a user namespace of its own and so may
// mount what is its own. False where this machine does not let people have namespaces.
inline bool run_in_namespace() {
  const std::string enter = "unshare --user --map-root-user --mount ";
  if (std::getenv("PHONOMIME_IN_NAMESPACE") != nullptr ||
      std::system((enter + "true 2> /dev/null").c_str()) != 0) {
    return false;
  }
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "PHONOMIME_IN_NAMESPACE=1 " + enter + "'" + program +
                              "' --gtest_filter=" + test->test_suite_name() + "." + test->name();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return true;
}

} // namespace phonomime::test

// Behind the making of a Mount: where this process may not mount, the test runs in a namespace
// instead, or is skipped. tools/lib/test_report.py accepts that from who has not the right to.
#define PHONOMIME_NEEDS_MOUNT(mount)                                                               \
  if (!(mount)) {                                                                                  \
    if (!::phonomime::test::run_in_namespace()) {                                                  \
      GTEST_SKIP() << "skipped: needs the right to mount";                                         \
    }                                                                                              \
    return;                                                                                        \
  }
