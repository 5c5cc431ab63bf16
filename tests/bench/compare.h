// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

namespace phonomime::bench {

// Throws where the answer that is about to be timed is wrong; phonomime_bench then stops with 1.
inline void verify(bool right, const std::string& what) {
  if (!right) {
    throw std::runtime_error("wrong answer: " + what);
  }
}

template <typename Work>
double seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  benchmark::DoNotOptimize(std::forward<Work>(work)());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Times `ours` against `plain` in alternation, so that whatever else the machine does falls on
// both. Both return a value. The benchmark's own time is that of `ours`; the counters are the plain
// version's median in seconds and the ratio of the medians. Register with ->UseManualTime().
template <typename Ours, typename Plain>
void compare(benchmark::State& state, Ours&& ours, Plain&& plain) {
  std::vector<double> ours_s;
  std::vector<double> plain_s;
  for ([[maybe_unused]] auto _ : state) {
    ours_s.push_back(seconds(ours));
    plain_s.push_back(seconds(plain));
    state.SetIterationTime(ours_s.back());
  }
  state.counters["plain_s"] = median(plain_s);
  state.counters["plain/ours"] = median(plain_s) / median(ours_s);
}

} // namespace phonomime::bench
