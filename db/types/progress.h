// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/errors.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

namespace phonomime {

// How long work tells where it is and hears that it should stop. Both parts may be empty.
struct Progress {
  // Called from one thread at a time: the stage's name, work done and work in all (same unit).
  std::function<void(std::string_view stage, std::int64_t done, std::int64_t total)> report;
  // Set by a signal handler; long loops look at it.
  const std::atomic<bool>* stop = nullptr;

  bool stop_requested() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }

  // Reports, then throws Interrupted where a stop is asked for. Not for parallel regions.
  void update(std::string_view stage, std::int64_t done, std::int64_t total) const {
    if (stop_requested()) {
      throw Interrupted();
    }
    if (report) {
      report(stage, done, total);
    }
  }
};

} // namespace phonomime
