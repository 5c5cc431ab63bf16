// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/segments.h"

#include <optional>
#include <span>

#include "db/types/errors.h"
#include "db/types/text.h"

namespace phonomime::demo {

std::vector<Segment> parse_festival_segments(std::string_view text, std::string_view where) {
  std::vector<Segment> segments;
  double start_s = 0.0;
  long line_number = 0;
  for (const std::string_view line : split_lines(text)) {
    ++line_number;
    const std::vector<std::string_view> words = split_words(line);
    if (words.empty() || line_number == 1)
      continue;
    const std::optional<double> end_s = parse_number(words[0]);
    if (words.size() != 3 || !end_s || *end_s < start_s)
      throw InputError({.where = at_line(where, line_number),
                        .what = "this is not a line of Festival's segments",
                        .expected = "a time that does not run back, 100 and a phoneme",
                        .got = quoted(line)});
    if (*end_s > start_s)
      segments.push_back({std::string(words[2]), start_s, *end_s});
    start_s = *end_s;
  }
  if (segments.empty())
    throw InputError({.where = std::string(where), .what = "there are no segments"});
  return segments;
}

} // namespace phonomime::demo
