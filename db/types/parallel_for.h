// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <exception>
#include <vector>

#include <omp.h>

namespace phonomime {

// body(i) for i = 0 .. count - 1 over `threads` threads (0: as many as there are). Nothing leaves
// the parallel region by an exception: they are kept, and the one of the least i is thrown after
// it. Who includes this links OpenMP::OpenMP_CXX.
template <typename Body>
void parallel_for(std::ptrdiff_t count, int threads, const Body& body) {
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  const int thread_count = threads > 0 ? threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic) num_threads(thread_count)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    try {
      body(i);
    } catch (...) {
      failures[static_cast<std::size_t>(i)] = std::current_exception();
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
}

} // namespace phonomime
