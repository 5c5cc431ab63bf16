// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/line_reader.h"

#include "db/types/errors.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace phonomime {

namespace {

constexpr int kLookAround_ms = 100;
constexpr std::size_t kLongestLine = std::size_t{1} << 16;
constexpr std::string_view kName = "standard input";

} // namespace

std::optional<std::string> LineReader::next() {
  std::size_t end = buffer_.find('\n');
  while (end == std::string::npos && !ended_) {
    wait();
    std::array<char, 4096> bytes{};
    const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR && errno != EAGAIN) {
      throw IoError(
          {.where = std::string(kName), .what = "cannot be read", .got = std::strerror(errno)});
    }
    ended_ = count == 0;
    const std::size_t before = buffer_.size();
    buffer_.append(bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
    end = buffer_.find('\n', before);
    if (end == std::string::npos && buffer_.size() > kLongestLine) {
      throw InputError({.where = at_line(kName, line_ + 1), .what = "the line is too long"});
    }
  }
  ++line_;
  if (end == std::string::npos) {
    return buffer_.empty() ? std::nullopt : std::optional(std::exchange(buffer_, {}));
  }
  std::string line = buffer_.substr(0, end);
  buffer_.erase(0, end + 1);
  return line;
}

void LineReader::wait() const {
  std::array<pollfd, 2> ends = {{{STDIN_FILENO, POLLIN, 0}, {STDOUT_FILENO, 0, 0}}};
  while (ends[0].revents == 0) {
    if (progress_.stop_requested()) {
      throw Interrupted();
    }
    const int ready = poll(ends.data(), ends.size(), kLookAround_ms);
    if (ready < 0 && errno != EINTR) {
      throw IoError({.where = std::string(kName),
                     .what = "cannot be waited for",
                     .got = std::strerror(errno)});
    }
    if (ready > 0 && (ends[1].revents & POLLERR) != 0) {
      throw IoError(
          {.where = "standard output", .what = "cannot be written", .got = std::strerror(EPIPE)});
    }
  }
}

} // namespace phonomime
