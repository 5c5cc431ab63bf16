// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/textgrid_tokens.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace phonomime {

namespace {
constexpr std::string_view kSpace = " \t\r\n\v\f";
constexpr std::array<std::string_view, 4> kKindNames = {"a number", "a string in quotes", "a flag",
                                                        "the end of the file"};
} // namespace

bool TextGridTokens::skip_space() {
  while (position_ < text_.size() && kSpace.find(text_[position_]) != std::string_view::npos) {
    const bool lone_return =
        text_[position_] == '\r' && (position_ + 1 == text_.size() || text_[position_ + 1] != '\n');
    current_line_ += text_[position_] == '\n' || lone_return ? 1 : 0;
    ++position_;
  }
  return position_ < text_.size();
}

void TextGridTokens::skip_line() {
  position_ = std::min(text_.find_first_of("\r\n", position_), text_.size());
}

// From behind the opening quote; a doubled quote stands for one.
TextGridTokens::Token TextGridTokens::read_string() {
  Token token{.kind = Kind::string, .number = 0.0, .text = {}};
  for (;;) {
    const std::size_t quote = text_.find('"', position_);
    if (quote == std::string_view::npos) {
      throw InputError({.where = at_line(where_, line_),
                        .what = "a string in quotes has no end",
                        .remedy = "The file seems to be cut off, or a quote inside a label is not "
                                  "doubled."});
    }
    const std::string_view part = text_.substr(position_, quote - position_);
    current_line_ += std::count(part.begin(), part.end(), '\n');
    token.text += part;
    position_ = quote + 1;
    if (position_ == text_.size() || text_[position_] != '"') {
      return token;
    }
    token.text += '"';
    ++position_;
  }
}

TextGridTokens::Token TextGridTokens::next() {
  while (skip_space()) {
    line_ = current_line_;
    if (text_[position_] == '!') {
      skip_line();
      continue;
    }
    if (text_[position_] == '"') {
      ++position_;
      return read_string();
    }
    const std::size_t end = std::min(text_.find_first_of(kSpace, position_), text_.size());
    const std::string_view word = text_.substr(position_, end - position_);
    position_ = end;
    if (word.size() >= 2 && word.front() == '<' && word.back() == '>') {
      return {
          .kind = Kind::flag, .number = 0.0, .text = std::string(word.substr(1, word.size() - 2))};
    }
    if (const std::optional<double> value = parse_number(word)) {
      return {.kind = Kind::number, .number = *value, .text = {}};
    }
  }
  line_ = current_line_;
  return {};
}

bool TextGridTokens::at_end() {
  const std::size_t position = position_;
  const long current_line = current_line_;
  const bool end = next().kind == Kind::end;
  position_ = position;
  current_line_ = current_line;
  return end;
}

TextGridTokens::Token TextGridTokens::expect(Kind kind, std::string_view name) {
  Token token = next();
  if (token.kind != kind) {
    const std::string got = token.kind == Kind::string   ? quoted(token.text)
                            : token.kind == Kind::number ? format_number(token.number)
                            : token.kind == Kind::flag
                                ? quoted("<" + token.text + ">")
                                : std::string(kKindNames[static_cast<std::size_t>(Kind::end)]);
    throw InputError({.where = at_line(where_, line_),
                      .what = fmt::format("{} is missing", name),
                      .expected = std::string(kKindNames[static_cast<std::size_t>(kind)]),
                      .got = got,
                      .remedy = token.kind == Kind::end ? "The file seems to be cut off." : ""});
  }
  return token;
}

double TextGridTokens::number(std::string_view name) {
  return expect(Kind::number, name).number;
}

long TextGridTokens::count(std::string_view name) {
  const double value = number(name);
  if (value < 0.0 || value > 1e9 || value != std::floor(value)) {
    throw InputError({.where = at_line(where_, line_),
                      .what = fmt::format("{} is not a count", name),
                      .expected = "a whole number of 0 or more",
                      .got = format_number(value)});
  }
  return static_cast<long>(value);
}

std::string TextGridTokens::string(std::string_view name) {
  return std::move(expect(Kind::string, name).text);
}

std::string TextGridTokens::flag(std::string_view name) {
  return std::move(expect(Kind::flag, name).text);
}

} // namespace phonomime
