// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// Lines of a text: LF, CRLF or CR ends, a UTF-8 byte order mark skipped. Views into `text`.
std::vector<std::string_view> split_lines(std::string_view text);

// Fields between single occurrences of `separator`, empty ones kept. Views into `line`.
std::vector<std::string_view> split_fields(std::string_view line, char separator);

// Fields between runs of spaces and tabs. Views into `line`.
std::vector<std::string_view> split_words(std::string_view line);

// Without leading and trailing white space (space, tab, CR, LF).
std::string_view trim(std::string_view text);

// ASCII only; other bytes stay as they are.
std::string to_lower(std::string_view text);

// A whole field as a finite decimal number ("1", "-0.5", "1e-3"), independent of locale; nothing
// for anything else, NaN and infinity included.
std::optional<double> parse_number(std::string_view field);

// A whole field as a decimal integer; nothing for anything else or on overflow.
std::optional<long> parse_integer(std::string_view field);

// Well-formed UTF-8 without embedded NUL.
bool is_valid_utf8(std::string_view text);

// A field as it may stand in a message: quoted, shortened to 40 characters, control characters and
// ill-formed bytes shown as '?'.
std::string quoted(std::string_view field);
// The same, where argument-dependent lookup would prefer std::quoted or could not choose.
inline std::string quoted(const char* field) {
  return quoted(std::string_view(field));
}
inline std::string quoted(const std::string& field) {
  return quoted(std::string_view(field));
}
inline std::string quoted(std::string& field) {
  return quoted(std::string_view(field));
}

// Up to `count` of `candidates`, nearest first by edit distance (ASCII case ignored), none farther
// than half of the longer word's length; ties keep the order given.
std::vector<std::string> nearest_candidates(std::string_view word,
                                            std::span<const std::string> candidates,
                                            std::size_t count = 3);

// `Did you mean "a" or "b"?`, or an empty string where there is no near candidate.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

// The shortest decimal text that reads back as the same number, '.' as decimal point.
std::string format_number(double value);

} // namespace phonomime
