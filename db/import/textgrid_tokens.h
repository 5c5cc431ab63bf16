// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace phonomime {

// The values of a Praat text file, as Praat itself reads them: what counts are numbers, "strings"
// and <flags> that stand free between white space; everything else (`xmin =`, `intervals [3]:`) is
// for people, and so is what follows a free-standing `!`. So the long and the short form are one.
class TextGridTokens {
public:
  // `text` is UTF-8 and outlives this.
  TextGridTokens(std::string_view text, std::string_view where) : text_(text), where_(where) {}

  // The next value. `name` says in errors what it is. Throws InputError where it is of another kind
  // or the file ends before it.
  double number(std::string_view name);
  long count(std::string_view name); // a whole number of 0 or more
  std::string string(std::string_view name);
  std::string flag(std::string_view name); // without < >

  bool at_end();
  std::size_t bytes_left() const { return text_.size() - position_; }
  long line() const { return line_; } // of the value read last, from 1

private:
  enum class Kind { number, string, flag, end };
  struct Token {
    Kind kind = Kind::end;
    double number = 0.0;
    std::string text;
  };

  Token next();
  Token read_string();
  Token expect(Kind kind, std::string_view name);
  void skip_line();
  bool skip_space(); // false at the end

  std::string_view text_;
  std::string_view where_;
  std::size_t position_ = 0;
  long current_line_ = 1;
  long line_ = 1;
};

} // namespace phonomime
