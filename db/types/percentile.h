// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

namespace phonomime {

// The value under which a share of the values lies, linear between the two nearest (Hyndman and
// Fan's type 7, numpy's and R's default): share 0 is the least, 1 the largest. Nothing of no
// values.
std::optional<double> percentile(std::vector<double> values, double share);

} // namespace phonomime
