// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/descent.h"

#include "db/types/errors.h"

#include <exception>

#include <nlopt.h>

namespace phonomime {

namespace {

constexpr double kFirstStep = 0.15; // of a side of the box

// NLopt's C functions: its C++ ones would not let every exception through.
struct Optimiser {
  explicit Optimiser(unsigned size)
      : handle(nlopt_create(size > 1 ? NLOPT_LN_BOBYQA : NLOPT_LN_SBPLX, size)) {
    if (handle == nullptr) {
      throw InternalError({.what = "NLopt made no optimiser"});
    }
  }
  Optimiser(const Optimiser&) = delete;
  Optimiser& operator=(const Optimiser&) = delete;
  ~Optimiser() { nlopt_destroy(handle); }

  nlopt_opt handle;
};

struct Course {
  const Objective& objective;
  nlopt_opt optimiser = nullptr;
  std::vector<Look> looks;
  std::exception_ptr failure;
};

double look(unsigned size, const double* point, double*, void* data) {
  Course& course = *static_cast<Course*>(data);
  try {
    const std::span at(point, size);
    if (const std::optional<double> value = course.objective(at)) {
      course.looks.push_back({.point = {at.begin(), at.end()}, .value = *value});
      return *value;
    }
  } catch (...) {
    course.failure = std::current_exception();
  }
  nlopt_force_stop(course.optimiser);
  return 0.0;
}

} // namespace

std::vector<Look> descend(const Objective& objective, std::span<const double> start,
                          int evaluations, double tolerance) {
  std::vector<double> point(start.begin(), start.end());
  const Optimiser optimiser(static_cast<unsigned>(point.size()));
  Course course{.objective = objective, .optimiser = optimiser.handle};
  nlopt_set_min_objective(optimiser.handle, look, &course);
  nlopt_set_lower_bounds1(optimiser.handle, 0.0);
  nlopt_set_upper_bounds1(optimiser.handle, 1.0);
  nlopt_set_initial_step1(optimiser.handle, kFirstStep);
  nlopt_set_xtol_abs1(optimiser.handle, tolerance);
  nlopt_set_maxeval(optimiser.handle, evaluations);
  double least = 0.0;
  const nlopt_result result = nlopt_optimize(optimiser.handle, point.data(), &least);
  if (course.failure) {
    std::rethrow_exception(course.failure);
  }
  if (result < 0 && result != NLOPT_FORCED_STOP && result != NLOPT_ROUNDOFF_LIMITED) {
    throw InternalError({.what = "NLopt failed", .got = nlopt_result_to_string(result)});
  }
  return std::move(course.looks);
}

} // namespace phonomime
