// SPDX-License-Identifier: GPL-3.0-or-later
// store_import_child DB NAME SENTENCES FRAMES [kill-at N | full-at N | limit BYTES]
//
// Imports a made corpus, and meets its end at the Nth operation with which SQLite changes the disk:
// killed by SIGKILL, or (full-at) told from then on that there is no space. `limit` sets
// RLIMIT_FSIZE. Prints the number of such operations. Exit status: that of the error's class.
#include "db/types/text.h"
#include "tests/db/store/made_corpus.h"

#include <sqlite3.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using phonomime::parse_integer;

long operations = 0;
long kill_at = -1;
long full_at = -1;

// True where the operation is to fail.
bool count_operation() {
  ++operations;
  if (operations == kill_at) {
    kill(getpid(), SIGKILL);
  }
  if (full_at > 0 && operations >= full_at) {
    errno = ENOSPC;
    return true;
  }
  return false;
}

ssize_t counted_pwrite(int file, const void* bytes, size_t count, off_t offset) {
  return count_operation() ? -1 : pwrite(file, bytes, count, offset);
}
ssize_t counted_write(int file, const void* bytes, size_t count) {
  return count_operation() ? -1 : write(file, bytes, count);
}
// Freeing needs no space.
int counted_truncate(int file, off_t size) {
  count_operation();
  return ftruncate(file, size);
}
int counted_unlink(const char* path) {
  count_operation();
  return unlink(path);
}

void watch_disk() {
  sqlite3_vfs* vfs = sqlite3_vfs_find("unix");
  const auto set = [vfs](const char* name, auto* function) {
    vfs->xSetSystemCall(vfs, name, reinterpret_cast<sqlite3_syscall_ptr>(function));
  };
  set("pwrite", counted_pwrite);
  set("pwrite64", counted_pwrite);
  set("write", counted_write);
  set("ftruncate", counted_truncate);
  set("unlink", counted_unlink);
}

void limit_file_size(long bytes) {
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 5 && argc != 7) {
    return 2;
  }
  const std::string path = argv[1], name = argv[2];
  const auto sentences = static_cast<int>(parse_integer(argv[3]).value());
  const auto frames = static_cast<int>(parse_integer(argv[4]).value());
  watch_disk();
  if (argc == 7) {
    const std::string how = argv[5];
    const long when = parse_integer(argv[6]).value();
    if (how == "kill-at") {
      kill_at = when;
    } else if (how == "full-at") {
      full_at = when;
    } else {
      limit_file_size(when);
    }
  }
  int status = 0;
  try {
    auto database = phonomime::MotionDatabase::open(path, phonomime::OpenMode::read_write);
    phonomime::test::import_corpus(database,
                                   phonomime::test::made_corpus(name, sentences, 20, frames));
  } catch (const phonomime::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    status = static_cast<int>(error.error_class());
  }
  std::printf("%ld\n", operations);
  return status;
}
