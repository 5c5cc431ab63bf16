// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/alignment_rows.h"
#include "db/import/readers.h"
#include "db/import/textgrid_tokens.h"
#include "db/import/unicode.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

constexpr double kRounding_s = 1e-6;
constexpr std::array<std::string_view, 8> kPhoneTierNames = {
    "phones", "phone", "phonemes", "phoneme", "segments", "segment", "mau", "phn"};

struct Span {
  double start_s = 0.0;
  double end_s = 0.0;
};

struct Tier {
  std::string name;
  bool has_intervals = false; // else points
  Span span;
  std::vector<AlignedLabel> rows;
};

Span read_span(TextGridTokens& tokens, std::string_view of, std::string_view where) {
  Span span;
  span.start_s = tokens.number(fmt::format("xmin of {}", of));
  span.end_s = tokens.number(fmt::format("xmax of {}", of));
  if (!(span.start_s < span.end_s)) {
    throw InputError({.where = at_line(where, tokens.line()),
                      .what = fmt::format("{} ends before it begins", of),
                      .expected = fmt::format("an xmax above {}", span.start_s),
                      .got = format_number(span.end_s)});
  }
  return span;
}

// A count that the rest of the file has no room for is told before it is believed: an item takes
// `smallest_bytes` in the shortest form there is.
long read_count(TextGridTokens& tokens, std::string_view name, std::size_t smallest_bytes,
                std::string_view where) {
  const long count = tokens.count(name);
  if (static_cast<std::size_t>(count) > tokens.bytes_left() / smallest_bytes) {
    throw InputError({.where = at_line(where, tokens.line()),
                      .what = fmt::format("{} is more than the file can hold", name),
                      .expected = fmt::format("at most {}", tokens.bytes_left() / smallest_bytes),
                      .got = std::to_string(count),
                      .remedy = "The file seems to be cut off."});
  }
  return count;
}

void read_intervals(TextGridTokens& tokens, Tier& tier, std::string_view where) {
  constexpr std::size_t kShortestInterval = 6; // `0 1 ""`
  const long count = read_count(tokens, fmt::format("the size of tier {}", quoted(tier.name)),
                                kShortestInterval, where);
  tier.rows.reserve(static_cast<std::size_t>(count));
  for (long i = 1; i <= count; ++i) {
    AlignedLabel row;
    row.start_s = tokens.number(fmt::format("xmin of interval {}", i));
    row.line = tokens.line();
    row.end_s = tokens.number(fmt::format("xmax of interval {}", i));
    row.label = trim(tokens.string(fmt::format("the text of interval {}", i)));
    tier.rows.push_back(std::move(row));
  }
}

void skip_points(TextGridTokens& tokens, const Tier& tier, std::string_view where) {
  constexpr std::size_t kShortestPoint = 4; // `0 ""`
  const long count = read_count(tokens, fmt::format("the size of tier {}", quoted(tier.name)),
                                kShortestPoint, where);
  for (long i = 1; i <= count; ++i) {
    tokens.number(fmt::format("the time of point {}", i));
    tokens.string(fmt::format("the mark of point {}", i));
  }
}

Tier read_tier(TextGridTokens& tokens, long number, std::string_view where) {
  const std::string kind = tokens.string(fmt::format("the class of tier {}", number));
  if (kind != "IntervalTier" && kind != "TextTier") {
    throw InputError({.where = at_line(where, tokens.line()),
                      .what = fmt::format("tier {} is of an unknown class", number),
                      .expected = "\"IntervalTier\" or \"TextTier\"",
                      .got = quoted(kind)});
  }
  Tier tier;
  tier.has_intervals = kind == "IntervalTier";
  tier.name = tokens.string(fmt::format("the name of tier {}", number));
  tier.span = read_span(tokens, fmt::format("tier {}", quoted(tier.name)), where);
  if (tier.has_intervals) {
    read_intervals(tokens, tier, where);
  } else {
    skip_points(tokens, tier, where);
  }
  return tier;
}

void read_header(TextGridTokens& tokens, std::string_view where) {
  const std::string file_type = tokens.string("the file type");
  if (file_type != "ooTextFile" && file_type != "ooTextFile short") {
    throw InputError({.where = at_line(where, tokens.line()),
                      .what = "is not a Praat text file",
                      .expected = "the file type \"ooTextFile\"",
                      .got = quoted(file_type)});
  }
  const std::string object_class = tokens.string("the object class");
  if (object_class != "TextGrid") {
    throw InputError({.where = at_line(where, tokens.line()),
                      .what = "is not a TextGrid",
                      .expected = "the object class \"TextGrid\"",
                      .got = quoted(object_class),
                      .remedy = "In Praat, select the TextGrid alone and save it as text."});
  }
}

std::vector<Tier> read_tiers(std::string_view text, std::string_view where) {
  TextGridTokens tokens(text, where);
  read_header(tokens, where);
  const Span span = read_span(tokens, "the TextGrid", where);
  const std::string tiers_flag = tokens.flag("the flag of the tiers");
  if (tiers_flag != "exists") {
    throw InputError({.where = at_line(where, tokens.line()),
                      .what = "the TextGrid has no tiers",
                      .expected = "<exists>",
                      .got = quoted("<" + tiers_flag + ">")});
  }
  constexpr std::size_t kShortestTier = 18; // `"TextTier" ""0 1 0`
  const long count = read_count(tokens, "the number of tiers", kShortestTier, where);
  std::vector<Tier> tiers;
  for (long i = 1; i <= count; ++i) {
    tiers.push_back(read_tier(tokens, i, where));
    const Tier& tier = tiers.back();
    if (tier.span.start_s < span.start_s - kRounding_s ||
        tier.span.end_s > span.end_s + kRounding_s) {
      throw InputError({.where = at_line(where, tokens.line()),
                        .what = fmt::format("tier {} goes beyond the TextGrid", quoted(tier.name)),
                        .expected = fmt::format("times from {} to {} s", span.start_s, span.end_s),
                        .got = fmt::format("{} to {} s", tier.span.start_s, tier.span.end_s)});
    }
  }
  if (!tokens.at_end()) {
    throw InputError({.where = std::string(where),
                      .what = "there is more in the file than its sizes say",
                      .expected = fmt::format("the end of the file after {} tiers", count)});
  }
  return tiers;
}

std::string tier_list(const std::vector<Tier>& tiers) {
  std::vector<std::string> names;
  for (const Tier& tier : tiers) {
    names.push_back(quoted(tier.name) + (tier.has_intervals ? "" : " (points)"));
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// "phones", "Ann - phones" and "phones - Ann" (aligners name tiers after the speaker).
bool names_phones(std::string_view tier_name) {
  const std::string name = to_lower(trim(tier_name));
  return std::ranges::any_of(kPhoneTierNames, [&](std::string_view phones) {
    return name == phones || name.ends_with(fmt::format(" - {}", phones)) ||
           name.starts_with(fmt::format("{} - ", phones));
  });
}

const Tier& choose_tier(const std::vector<Tier>& tiers, std::string_view wanted,
                        std::string_view where) {
  std::vector<const Tier*> found;
  const auto collect = [&](auto&& fits) {
    for (const Tier& tier : tiers) {
      if (fits(tier)) {
        found.push_back(&tier);
      }
    }
  };
  if (wanted.empty()) {
    collect([](const Tier& tier) { return tier.has_intervals && names_phones(tier.name); });
  } else {
    collect([&](const Tier& tier) { return tier.name == wanted; });
    if (found.empty()) {
      collect([&](const Tier& tier) { return to_lower(tier.name) == to_lower(wanted); });
    }
  }
  if (found.size() == 1 && found.front()->has_intervals) {
    return *found.front();
  }
  const std::string asked =
      wanted.empty() ? std::string("a phone tier") : fmt::format("tier {}", quoted(wanted));
  const std::string what = found.empty() ? fmt::format("{} is not in the TextGrid", asked)
                           : found.size() > 1
                               ? fmt::format("{} is there {} times", asked, found.size())
                               : fmt::format("{} holds points, not intervals", asked);
  throw InputError({.where = std::string(where),
                    .what = what,
                    .expected = wanted.empty() ? "one interval tier called phones, phonemes, "
                                                 "segments or MAU"
                                               : "one interval tier of that name",
                    .got = "the tiers " + tier_list(tiers),
                    .remedy = "Name the phone tier."});
}

} // namespace

Alignment parse_textgrid(std::string_view bytes, std::string_view where, std::string_view tier) {
  if (bytes.starts_with("ooBinaryFile")) {
    throw InputError({.where = std::string(where),
                      .what = "binary TextGrids (ooBinaryFile) are not supported",
                      .expected = "a TextGrid saved as text",
                      .remedy = "In Praat, choose Save as text file."});
  }
  const std::string text = decode_text(bytes, where);
  const std::vector<Tier> tiers = read_tiers(text, where);
  const Tier& chosen = choose_tier(tiers, tier, where);
  Alignment alignment{.source = std::string(where), .rows = {}};
  for (const AlignedLabel& row : chosen.rows) {
    if (row.start_s < chosen.span.start_s - kRounding_s ||
        row.end_s > chosen.span.end_s + kRounding_s) {
      throw InputError(
          {.where = at_line(where, row.line),
           .what = fmt::format("the interval goes beyond tier {}", quoted(chosen.name)),
           .expected = fmt::format("times from {} to {} s", chosen.span.start_s, chosen.span.end_s),
           .got = fmt::format("{} to {} s", row.start_s, row.end_s)});
    }
    append_row(alignment, row);
  }
  require_rows(alignment);
  return alignment;
}

} // namespace phonomime
