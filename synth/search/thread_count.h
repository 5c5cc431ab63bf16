// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <omp.h>

namespace phonomime {

// Sets OpenMP's thread count for a scope; 0 leaves it.
class ThreadCount {
public:
  explicit ThreadCount(int threads) : before_(omp_get_max_threads()) {
    if (threads > 0) {
      omp_set_num_threads(threads);
    }
  }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;
  ~ThreadCount() { omp_set_num_threads(before_); }

private:
  int before_;
};

} // namespace phonomime
