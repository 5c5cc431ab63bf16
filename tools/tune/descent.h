// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace phonomime {

// What is to become small, at a point of the box of sides 0 to 1. Nothing: it is not to be asked
// any more, the best so far has to do.
using Objective = std::function<std::optional<double>(std::span<const double> point)>;

// A point that was looked at.
struct Look {
  std::vector<double> point;
  double value = 0.0;
};

// Goes down from `start` by BOBYQA (Powell 2009: a quadratic model through the last points, no
// derivatives; NLopt's) and returns every look in its order: at most `evaluations`, the first at
// `start`. Ends when steps get shorter than `tolerance`. The looks depend on nothing but the
// values. Whatever `objective` throws comes through. A box of one side is gone down by SBPLX, since
// BOBYQA takes two at least.
std::vector<Look> descend(const Objective& objective, std::span<const double> start,
                          int evaluations, double tolerance = 0.01);

} // namespace phonomime
