// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/file_io.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

[[noreturn]] void throw_io(const std::filesystem::path& path, std::string_view what, int error) {
  throw IoError({.where = path.string(), .what = std::string(what), .got = std::strerror(error)});
}

class FileDescriptor {
public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { ::close(fd_); }
  int get() const { return fd_; }

private:
  int fd_;
};

void write_all(int fd, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      throw_io(path, "cannot be written", errno);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

// Renaming onto a device would put a file in the device's place.
void require_replaceable(const std::filesystem::path& target) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(target, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw IoError({.where = target.string(),
                   .what = std::filesystem::is_directory(status) ? "is a folder" : "is a device",
                   .expected = "the path of a file"});
  }
}

// A new file in the target's folder, with the permissions that the user's mask allows.
std::pair<int, std::filesystem::path> create_beside(const std::filesystem::path& target) {
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::filesystem::path temporary = target;
    temporary += fmt::format(".part-{}-{}", ::getpid(), attempt);
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0) {
      return {fd, temporary};
    }
    if (errno != EEXIST) {
      break;
    }
  }
  throw_io(target, "cannot be created", errno);
}

} // namespace

std::string read_file(const std::filesystem::path& path, std::uintmax_t largest_bytes) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) {
    throw_io(path, "cannot be opened for reading", errno);
  }
  const FileDescriptor file(fd);
  struct stat status {};
  if (::fstat(fd, &status) != 0) {
    throw_io(path, "cannot be examined", errno);
  }
  if (S_ISDIR(status.st_mode)) {
    throw InputError({.where = path.string(), .what = "is a folder", .expected = "a file"});
  }
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(
      std::min<std::uintmax_t>(largest_bytes, static_cast<std::uintmax_t>(status.st_size))));
  char buffer[1 << 16];
  for (;;) {
    const ssize_t count = ::read(fd, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      throw_io(path, "cannot be read", errno);
    }
    if (count == 0) {
      return bytes;
    }
    bytes.append(buffer, static_cast<std::size_t>(count));
    if (bytes.size() > largest_bytes) {
      throw InputError({.where = path.string(),
                        .what = "the file is too large",
                        .expected = fmt::format("at most {} bytes", largest_bytes)});
    }
  }
}

OutputFiles::~OutputFiles() {
  for (const Staged& file : staged_) {
    ::unlink(file.temporary.c_str());
  }
}

void OutputFiles::stage(const std::filesystem::path& target, std::string_view bytes) {
  require_replaceable(target);
  const auto [fd, temporary] = create_beside(target);
  const FileDescriptor file(fd);
  staged_.push_back({temporary, target});
  write_all(fd, bytes, target);
  if (::fsync(fd) != 0) {
    throw_io(target, "cannot be written", errno);
  }
}

void OutputFiles::commit() {
  for (const Staged& file : staged_) {
    require_replaceable(file.target);
  }
  while (!staged_.empty()) {
    if (::rename(staged_.front().temporary.c_str(), staged_.front().target.c_str()) != 0) {
      throw_io(staged_.front().target, "cannot be put in place", errno);
    }
    staged_.erase(staged_.begin());
  }
}

void write_file(const std::filesystem::path& target, std::string_view bytes) {
  OutputFiles files;
  files.stage(target, bytes);
  files.commit();
}

} // namespace phonomime
