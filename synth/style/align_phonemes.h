// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace phonomime {

// Which phonemes of two readings of a sentence are the same: pairs (into first, into second) of
// equal phonemes, both rising, of an alignment of least edit distance (insertion, deletion and
// exchange cost 1 each). Of several such alignments, the one that pairs later phonemes first.
std::vector<std::pair<std::size_t, std::size_t>>
align_phonemes(std::span<const std::int32_t> first, std::span<const std::int32_t> second);

} // namespace phonomime
