// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/tune/descent.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace phonomime {

// How a least value is looked for that lies in one of many valleys (E VI-D starts hundreds of
// descents at random; looking at the places first saves most of them).
struct ManyStarts {
  int starts = 0;      // points drawn, beside the first one
  int descents = 1;    // from the best of these points and of the first one
  int evaluations = 1; // of each descent, at most
  std::uint64_t seed = 1;
};

// All looks: at the first point, at those drawn, then descent by descent. Never empty, unless the
// first point was not to be asked.
struct Search {
  std::vector<Look> looks;

  // Of the least value, the earliest of several.
  const Look& best() const;
};

// count points of a box of sides 0 to 1 by Latin hypercube: of each side, every count-th part has
// one point.
std::vector<std::vector<double>> draw_points(std::size_t sides, std::size_t count,
                                             std::uint64_t seed);

// body(i) for each i < count, in any order and several at a time; it does not throw.
using ShareOut =
    std::function<void(std::size_t count, const std::function<void(std::size_t i)>& body)>;

// Searches several objectives at a time. Each descent and each look at a point of the start is a
// piece of work of its own, and what comes out depends neither on their order nor on how many are
// done at a time. The points are the same for all. Throws what an objective throws, the first in
// order; work that has not begun then is left.
std::vector<Search> search_from_many_starts(std::span<const Objective> objectives,
                                            std::span<const double> first_point,
                                            const ManyStarts& options, const ShareOut& share_out);

} // namespace phonomime
