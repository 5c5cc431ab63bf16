// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/terminal.h"

#include "db/types/errors.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>
#include <unistd.h>

#include <fmt/format.h>

namespace phonomime {

namespace {

// The one piece of state that a signal handler may touch.
std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void request_stop(int) {
  // A second signal ends the program at once, as it would have without us.
  if (stop_requested.exchange(true)) {
    _exit(static_cast<int>(ErrorClass::interrupted));
  }
}

constexpr std::string_view kWipeLine = "\r\033[K";

void show_progress(std::string_view stage, std::int64_t done, std::int64_t total) {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point last_shown;
  const Clock::time_point now = Clock::now();
  if (now - last_shown < std::chrono::milliseconds(80)) {
    return;
  }
  last_shown = now;
  constexpr int kBarCells = 24;
  const double share = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 0.0;
  const auto filled = static_cast<std::size_t>(share * kBarCells);
  std::string bar(kBarCells, '.');
  bar.replace(0, filled, filled, '#');
  fmt::print(stderr, "{}{} [{}] {}/{}", kWipeLine, stage, bar, done, total);
  std::fflush(stderr);
}

} // namespace

Progress terminal_progress(bool quiet) {
  struct sigaction action {};
  action.sa_handler = request_stop;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  Progress progress;
  progress.stop = &stop_requested;
  if (!quiet && isatty(STDERR_FILENO)) {
    progress.report = show_progress;
  }
  return progress;
}

void clear_progress() {
  if (isatty(STDERR_FILENO)) {
    fmt::print(stderr, "{}", kWipeLine);
  }
}

void print(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw IoError(
        {.where = "standard output", .what = "cannot be written", .got = std::strerror(errno)});
  }
}

void print_message(std::string_view text) {
  clear_progress();
  fmt::print(stderr, "{}\n", text);
}

} // namespace phonomime
