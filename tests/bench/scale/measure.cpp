// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/scale/measure.h"

#include "synth/search/step_costs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include <sys/wait.h>
#include <unistd.h>

namespace phonomime::bench {

TimeLimit::TimeLimit(double limit_s)
    : clock_([this, limit_s] {
        std::unique_lock lock(mutex_);
        if (!ended_.wait_for(lock, std::chrono::duration<double>(limit_s), [&] { return done_; })) {
          stop_ = true;
        }
      }) {}

TimeLimit::~TimeLimit() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  ended_.notify_one();
  clock_.join();
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
  return values[at];
}

double fitted_exponent(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]);
    const double v = std::log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

bool same_path(const NodePath& a, const NodePath& b) {
  return a.cost == b.cost && a.nodes == b.nodes;
}

double cost_of_path(const JoinCost& cost, std::span<const SearchStep> steps,
                    std::span<const NodeIndex> nodes) {
  double sum = 0.0;
  for (std::size_t t = 0; t < steps.size(); ++t) {
    const MotionNode& info = cost.table().nodes[static_cast<std::size_t>(nodes[t])];
    const double own = step_penalty(steps[t], info, cost.weights());
    sum = t == 0 ? own : (sum + cost.transition(nodes[t - 1], nodes[t])) + own;
  }
  return sum;
}

std::vector<double> in_child(const std::function<std::vector<double>()>& work) {
  int ends[2];
  if (pipe(ends) != 0) {
    throw std::runtime_error("no pipe");
  }
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) {
    throw std::runtime_error("no child process");
  }
  if (child == 0) {
    int status = 0;
    try {
      const std::vector<double> numbers = work();
      const std::size_t bytes = numbers.size() * sizeof(double);
      status = write(ends[1], numbers.data(), bytes) == static_cast<ssize_t>(bytes) ? 0 : 1;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "phonomime_scale_bench: %s\n", error.what());
      status = 1;
    }
    std::fflush(nullptr);
    _exit(status);
  }
  close(ends[1]);
  std::vector<double> numbers;
  double number = 0.0;
  while (read(ends[0], &number, sizeof number) == static_cast<ssize_t>(sizeof number)) {
    numbers.push_back(number);
  }
  close(ends[0]);
  int status = 0;
  if (waitpid(child, &status, 0) != child || status != 0) {
    throw std::runtime_error("a child process failed");
  }
  return numbers;
}

} // namespace phonomime::bench
