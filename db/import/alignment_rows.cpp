// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/alignment_rows.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {
constexpr double kRounding_s = 1e-6;
}

void append_row(Alignment& alignment, AlignedLabel row) {
  const auto fail = [&](std::string what, std::string expected, std::string got) {
    throw InputError({.where = at_line(alignment.source, row.line),
                      .what = std::move(what),
                      .expected = std::move(expected),
                      .got = std::move(got)});
  };
  if (!std::isfinite(row.start_s) || !std::isfinite(row.end_s) || row.start_s < 0.0) {
    fail("the row's time is before 0", "a time of 0 or later", fmt::format("{} s", row.start_s));
  }
  if (!alignment.rows.empty()) {
    const double previous_end_s = alignment.rows.back().end_s;
    if (row.end_s < previous_end_s) {
      fail("the times run backwards", fmt::format("an end after {} s", previous_end_s),
           fmt::format("{} s", row.end_s));
    }
    if (row.start_s < previous_end_s - kRounding_s) {
      fail("the row overlaps the one before it",
           fmt::format("a start at or after {} s", previous_end_s),
           fmt::format("{} s", row.start_s));
    }
    row.start_s = std::max(row.start_s, previous_end_s);
  }
  if (row.end_s < row.start_s) {
    fail("the row ends before it begins", fmt::format("an end after {} s", row.start_s),
         fmt::format("{} s", row.end_s));
  }
  alignment.rows.push_back(std::move(row));
}

void require_rows(const Alignment& alignment) {
  if (alignment.rows.empty()) {
    throw InputError({.where = alignment.source,
                      .what = "the alignment has no rows",
                      .expected = "at least one phone"});
  }
}

} // namespace phonomime
