// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/parallel_for.h"
#include "db/types/progress.h"

#include <cstddef>
#include <mutex>
#include <string_view>

namespace phonomime {

// parallel_for that tells how many of its pieces are done, in the order in which they end, and
// hears that it should stop: pieces that are not begun by then are left out. Throws Interrupted.
template <typename Body>
void parallel_for(std::ptrdiff_t count, int threads, const Progress& progress,
                  std::string_view stage, const Body& body) {
  std::mutex mutex;
  std::ptrdiff_t done = 0;
  progress.update(stage, 0, count);
  parallel_for(count, threads, [&](std::ptrdiff_t i) {
    if (progress.stop_requested()) {
      throw Interrupted();
    }
    body(i);
    const std::scoped_lock lock(mutex);
    progress.update(stage, ++done, count);
  });
}

} // namespace phonomime
