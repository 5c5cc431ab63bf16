// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace phonomime {

// As many as are asked for; 0: one for each core.
std::size_t worker_count(int threads);

// body(worker, i) for each i < count once, in order of i as workers (numbers below `workers`) get
// free, one of them in the calling thread. They are threads of their own, each of which may use
// OpenMP. Once `stop` is set no further i begins; the call ends when those that have begun are
// done. `body` must not throw. Where the system gives fewer threads, there are fewer workers.
void share_out(std::size_t count, std::size_t workers, const std::atomic<bool>* stop,
               const std::function<void(std::size_t worker, std::size_t i)>& body);

} // namespace phonomime
