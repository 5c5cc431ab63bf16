// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/node_constraint.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::string_view kLineForm =
    "INDEX use KEY..., INDEX avoid KEY... or at SECONDS use KEY...";

// Keys hold a '#': a comment begins with one at the start of a line or after white space.
std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')) {
      return line.substr(0, i);
    }
  }
  return line;
}

long parse_index(std::string_view field, std::string_view where) {
  const std::optional<long> index = parse_integer(field);
  if (!index || *index < 0) {
    throw InputError({.where = std::string(where),
                      .what = "a constraint does not begin with a place",
                      .expected = "the index of a phoneme, counted from 0, or \"at SECONDS\"",
                      .got = quoted(field),
                      .remedy = parse_number(field).value_or(-1.0) >= 0.0
                                    ? fmt::format("A time is written \"at {}\".", field)
                                    : ""});
  }
  return *index;
}

double parse_time(std::string_view field, std::string_view where) {
  const std::optional<double> time = parse_number(field);
  if (!time || *time < 0.0) {
    throw InputError({.where = std::string(where),
                      .what = "the time of a constraint is not a time",
                      .expected = "seconds from 0 on, as in \"at 1.25\"",
                      .got = quoted(field)});
  }
  return *time;
}

ConstraintKind parse_kind(std::string_view word, std::string_view where) {
  if (word != "use" && word != "avoid") {
    throw InputError({.where = std::string(where),
                      .what = "a constraint does not say what to do",
                      .expected = "\"use\" or \"avoid\"",
                      .got = quoted(word)});
  }
  return word == "use" ? ConstraintKind::use : ConstraintKind::avoid;
}

std::string parse_key(std::string_view word, std::string_view where) {
  const std::size_t hash = word.rfind('#');
  const bool is_key =
      hash != std::string_view::npos && hash > 0 && hash + 1 < word.size() &&
      std::ranges::all_of(word.substr(hash + 1), [](char c) { return c >= '0' && c <= '9'; });
  if (!is_key) {
    throw InputError({.where = std::string(where),
                      .what = "a constraint names something that is not the key of a motion node",
                      .expected = "sentence#order, as in happiness/s017#5",
                      .got = quoted(word)});
  }
  return std::string(word);
}

NodeConstraint parse_line(std::string_view line, std::string_view where) {
  NodeConstraint constraint{.where = std::string(where)};
  const std::vector<std::string_view> all_words = split_words(line);
  std::span<const std::string_view> words = all_words;
  const std::size_t place_words = words[0] == "at" ? 2 : 1;
  if (words.size() < place_words + 2) {
    throw InputError({.where = std::string(where),
                      .what = "a constraint is incomplete",
                      .expected = std::string(kLineForm),
                      .got = quoted(line)});
  }
  if (place_words == 2) {
    constraint.time_s = parse_time(words[1], where);
  } else {
    constraint.index = parse_index(words[0], where);
  }
  constraint.kind = parse_kind(words[place_words], where);
  for (const std::string_view word : words.subspan(place_words + 1)) {
    constraint.keys.push_back(parse_key(word, where));
  }
  return constraint;
}

} // namespace

std::vector<NodeConstraint> parse_constraints(std::string_view text, std::string_view where) {
  if (!is_valid_utf8(text)) {
    throw InputError({.where = std::string(where),
                      .what = "is not UTF-8 text",
                      .expected = fmt::format("lines of {}", kLineForm)});
  }
  std::vector<NodeConstraint> constraints;
  long number = 0;
  for (std::string_view line : split_lines(text)) {
    ++number;
    line = trim(without_comment(line));
    if (!line.empty()) {
      constraints.push_back(parse_line(line, at_line(where, number)));
    }
  }
  return constraints;
}

} // namespace phonomime
