// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/search/join_cost.h"

#include <cstddef>
#include <span>

namespace phonomime::bench {

// A forward beam: of every step only the `width` states of least cost are kept. Not exact. Joins
// that cannot come into the beam are not computed, so that its time is that of a good beam. `cost`
// must know all nodes. NodePath::steps stays empty.
NodePath beam_search(const JoinCost& cost, std::span<const SearchStep> steps, std::size_t width);

} // namespace phonomime::bench
