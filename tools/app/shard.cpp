// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/shard.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <optional>
#include <vector>

#include <fmt/format.h>

namespace phonomime {

Shard parse_shard(std::string_view text) {
  const std::vector<std::string_view> parts = split_fields(text, '/');
  if (parts.size() == 2) {
    const std::optional<long> number = parse_integer(parts[0]);
    const std::optional<long> count = parse_integer(parts[1]);
    if (number && count && 1 <= *number && *number <= *count) {
      return {.number = *number, .count = *count};
    }
  }
  throw UsageError({.where = "--shard",
                    .what = "is not a shard",
                    .expected = "I/N, whole numbers with 1 <= I <= N",
                    .got = quoted(text)});
}

std::string format_shard(const Shard& shard) {
  return fmt::format("{}/{}", shard.number, shard.count);
}

} // namespace phonomime
