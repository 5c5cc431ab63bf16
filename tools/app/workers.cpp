// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/workers.h"

#include <algorithm>
#include <system_error>
#include <thread>
#include <vector>

namespace phonomime {

std::size_t worker_count(int threads) {
  return threads > 0 ? static_cast<std::size_t>(threads)
                     : std::max(1u, std::thread::hardware_concurrency());
}

void share_out(std::size_t count, std::size_t workers, const std::atomic<bool>* stop,
               const std::function<void(std::size_t worker, std::size_t i)>& body) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&](std::size_t worker) {
    while (stop == nullptr || !stop->load(std::memory_order_relaxed)) {
      const std::size_t i = next.fetch_add(1);
      if (i >= count) {
        break;
      }
      body(worker, i);
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t worker = 1; worker < workers && worker < count; ++worker) {
    try {
      threads.emplace_back(work, worker);
    } catch (const std::system_error&) {
      break;
    }
  }
  work(0);
}

} // namespace phonomime
