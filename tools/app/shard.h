// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace phonomime {

// One part of a batch that is split over machines: of `count` shards the one with this number. The
// shards of one count hold every row together, and no row twice.
struct Shard {
  long number = 1; // from 1
  long count = 1;

  // Rows are counted from 0: row r is in shard r mod count + 1, so that each shard gets rows from
  // everywhere in the manifest.
  bool holds(std::size_t row) const {
    return static_cast<long>(row % static_cast<std::size_t>(count)) == number - 1;
  }
};

// "i/n" with 1 <= i <= n. Throws UsageError.
Shard parse_shard(std::string_view text);

// The text that parse_shard reads.
std::string format_shard(const Shard& shard);

} // namespace phonomime
