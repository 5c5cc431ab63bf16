// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "synth/search/viterbi_search.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace phonomime::bench {

// Asks for a stop after some time, so that a slow run is reported and not awaited.
class TimeLimit {
public:
  explicit TimeLimit(double limit_s);
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  ~TimeLimit();

  Progress progress() const { return {.report = {}, .stop = &stop_}; }

private:
  std::atomic<bool> stop_ = false;
  bool done_ = false;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::thread clock_;
};

// The value below which `share` of the values are; `values` not empty.
double quantile(std::vector<double> values, double share);

// Exponent b of y = a x^b, least squares of the logarithms.
double fitted_exponent(std::span<const double> x, std::span<const double> y);

// Whether the two have the same cost, to the bit, and the same nodes.
bool same_path(const NodePath& a, const NodePath& b);

// E4 of given nodes, summed as the search does.
double cost_of_path(const JoinCost& cost, std::span<const SearchStep> steps,
                    std::span<const NodeIndex> nodes);

// Numbers from `work` done in a process of its own, which begins as small as this one is.
std::vector<double> in_child(const std::function<std::vector<double>()>& work);

} // namespace phonomime::bench
