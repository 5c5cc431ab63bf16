// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/svg_drawing.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>

namespace phonomime {
namespace {

constexpr std::array<std::string_view, 17> kGeometry = {
    "d",  "points", "cx", "cy", "r",     "rx",     "ry",           "x",      "y",
    "x1", "y1",     "x2", "y2", "width", "height", "stroke-width", "opacity"};

bool is_geometry(std::string_view name) {
  return name == "transform" || std::ranges::find(kGeometry, name) != kGeometry.end();
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// The length of the number that the text begins with (SVG 1.1 section 4.2), 0 for none.
std::size_t number_length(std::string_view text) {
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  std::size_t digits = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    ++digits;
  }
  if (at < text.size() && text[at] == '.') {
    ++at;
    for (; at < text.size() && is_digit(text[at]); ++at) {
      ++digits;
    }
  }
  if (digits == 0) {
    return 0;
  }
  if (at + 1 < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t end = at + 1 + (text[at + 1] == '-' || text[at + 1] == '+' ? 1 : 0);
    if (end < text.size() && is_digit(text[end])) {
      while (end < text.size() && is_digit(text[end])) {
        ++end;
      }
      at = end;
    }
  }
  return at;
}

// What stands between two numbers, whichever way it is spaced.
std::string separator(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c != ',' && std::isspace(static_cast<unsigned char>(c)) == 0) {
      result += c;
    }
  }
  return result.empty() ? " " : result;
}

std::string formatted(double value) {
  const std::string text = fmt::format("{:.3f}", value);
  std::string_view view = text;
  while (view.back() == '0') {
    view.remove_suffix(1);
  }
  if (view.back() == '.') {
    view.remove_suffix(1);
  }
  return view == "-0" ? "0" : std::string(view);
}

// For a script's text between single quotes; lines in an attribute end in no other way than blanks.
std::string in_quotes(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'' || c == '\\') {
      result += '\\';
    }
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result;
}

} // namespace

SvgDrawing::SvgDrawing(std::string text, std::string where)
    : text_(std::move(text)), where_(std::move(where)) {
  std::size_t elements = 0;
  bool is_svg = false;
  std::size_t at = 0;
  const auto broken = [&](const std::string& what) {
    return InputError({.where = where_, .what = what, .expected = "an SVG drawing"});
  };
  const auto skip_past = [&](std::string_view end) {
    const std::size_t found = text_.find(end, at);
    if (found == std::string::npos) {
      throw broken("the text ends inside a tag");
    }
    at = found + end.size();
  };
  while ((at = text_.find('<', at)) != std::string::npos) {
    const std::string_view rest = std::string_view(text_).substr(at);
    if (rest.starts_with("<!--")) {
      skip_past("-->");
      continue;
    }
    if (rest.starts_with("<![CDATA[")) {
      skip_past("]]>");
      continue;
    }
    if (rest.starts_with("</svg")) {
      end_of_root_ = at;
    }
    if (rest.starts_with("<?") || rest.starts_with("<!") || rest.starts_with("</")) {
      skip_past(">");
      continue;
    }
    ++at;
    const std::size_t name_end = text_.find_first_of(" \t\r\n/>", at);
    if (name_end == std::string::npos) {
      throw broken("the text ends inside a tag");
    }
    const std::string tag = text_.substr(at, name_end - at);
    is_svg = is_svg || (elements == 0 && tag == "svg");
    at = name_end;
    while (true) {
      at = text_.find_first_not_of(" \t\r\n/", at);
      if (at == std::string::npos) {
        throw broken("the text ends inside a tag");
      }
      if (text_[at] == '>') {
        break;
      }
      const std::size_t equals = text_.find_first_of("=>", at);
      if (equals == std::string::npos || text_[equals] != '=') {
        throw broken("an attribute of <" + tag + "> has no value");
      }
      const std::string name(trim(std::string_view(text_).substr(at, equals - at)));
      const std::size_t quote = text_.find_first_not_of(" \t\r\n", equals + 1);
      if (quote == std::string::npos || (text_[quote] != '"' && text_[quote] != '\'')) {
        throw broken("an attribute of <" + tag + "> is not quoted");
      }
      const std::size_t close = text_.find(text_[quote], quote + 1);
      if (close == std::string::npos) {
        throw broken("the text ends inside a tag");
      }
      if (elements > 0 && is_geometry(name)) { // the size of the whole picture stays
        read_attribute(elements, tag, name, quote + 1, close);
      }
      at = close + 1;
    }
    ++elements;
  }
  if (!is_svg || end_of_root_ == 0) {
    throw broken("the text is no SVG document");
  }
  if (numbers_.size() == 0) {
    throw broken("the drawing has no shapes");
  }
}

void SvgDrawing::read_attribute(std::size_t element, const std::string& tag,
                                const std::string& name, std::size_t start, std::size_t end) {
  Slot slot{element, tag, name, start, end, {}, numbers_.size()};
  std::string_view rest = std::string_view(text_).substr(start, end - start);
  std::vector<double> found;
  std::string before;
  while (!rest.empty()) {
    const std::size_t length = number_length(rest);
    if (length == 0) {
      before += rest.front();
      rest.remove_prefix(1);
      continue;
    }
    std::string_view digits = rest.substr(0, length);
    if (digits.front() == '+') {
      digits.remove_prefix(1);
    }
    const std::optional<double> value = parse_number(digits);
    if (!value) {
      throw InputError(
          {.where = where_, .what = "a number is out of range", .got = quoted(digits)});
    }
    found.push_back(*value);
    slot.between.push_back(found.size() == 1 ? std::string(trim(before)) : separator(before));
    before.clear();
    rest.remove_prefix(length);
  }
  if (found.empty()) {
    return;
  }
  slot.between.push_back(std::string(trim(before)));
  numbers_.conservativeResize(slot.first + std::ssize(found));
  for (std::size_t i = 0; i < found.size(); ++i) {
    numbers_[slot.first + static_cast<Eigen::Index>(i)] = found[i];
  }
  slots_.push_back(std::move(slot));
}

std::vector<std::string> SvgDrawing::number_names() const {
  std::vector<std::string> names;
  for (const Slot& slot : slots_) {
    for (std::size_t i = 0; i + 1 < slot.between.size(); ++i) {
      names.push_back(
          fmt::format("<{}> {}, {}, number {}", slot.tag, slot.element, slot.attribute, i + 1));
    }
  }
  return names;
}

void SvgDrawing::check_equal_structure(const SvgDrawing& other) const {
  const auto name = [](const Slot& slot) {
    return fmt::format("<{}> with {} numbers in {}", slot.tag, slot.between.size() - 1,
                       slot.attribute);
  };
  for (std::size_t i = 0; i < std::max(slots_.size(), other.slots_.size()); ++i) {
    const bool here = i < slots_.size();
    const bool there = i < other.slots_.size();
    const bool equal = here && there && slots_[i].tag == other.slots_[i].tag &&
                       slots_[i].attribute == other.slots_[i].attribute &&
                       slots_[i].between == other.slots_[i].between;
    if (!equal) {
      throw InputError(
          {.where = other.where_,
           .what = fmt::format("the drawing is built otherwise than {}, at its element {}", where_,
                               (there ? other.slots_[i] : slots_[i]).element),
           .expected = here ? name(slots_[i]) : "no further shape",
           .got = there ? name(other.slots_[i]) : "none",
           .remedy = "Draw it by moving the points of the drawing at rest."});
    }
  }
}

std::string SvgDrawing::value(const Slot& slot,
                              const Eigen::Ref<const Eigen::RowVectorXd>& numbers) const {
  std::string text = slot.between.front();
  for (std::size_t i = 0; i + 1 < slot.between.size(); ++i) {
    text += formatted(numbers[slot.first + static_cast<Eigen::Index>(i)]) + slot.between[i + 1];
  }
  return text;
}

std::string SvgDrawing::with(const Eigen::Ref<const Eigen::RowVectorXd>& numbers) const {
  std::string result;
  std::size_t copied = 0;
  for (const Slot& slot : slots_) {
    result += text_.substr(copied, slot.start - copied) + value(slot, numbers);
    copied = slot.end;
  }
  return result + text_.substr(copied);
}

std::string SvgDrawing::animated(const FrameMatrixD& frames, double rate_hz) const {
  std::string script;
  for (const Slot& slot : slots_) {
    const auto count = static_cast<Eigen::Index>(slot.between.size()) - 1;
    const auto own = frames.middleCols(slot.first, count);
    if ((own.rowwise() - own.row(0)).isZero(0.0)) {
      continue;
    }
    std::string values;
    for (const auto& frame : frames.rowwise()) {
      values += (values.empty() ? "'" : ",'") + in_quotes(value(slot, frame)) + "'";
    }
    script += fmt::format("[{},'{}',[{}]],\n", slot.element, slot.attribute, values);
  }
  const std::string still = with(frames.row(0));
  const std::size_t end = still.rfind("</svg");
  return still.substr(0, end) +
         fmt::format("<script><![CDATA[\n"
                     "const rate = {}, count = {}, moving = [\n{}];\n"
                     "const root = document.documentElement;\n"
                     "const all = [root, ...root.querySelectorAll('*')];\n"
                     "function show(frame) {{\n"
                     "  for (const [element, name, values] of moving)\n"
                     "    all[element].setAttribute(name, values[frame]);\n"
                     "}}\n"
                     "function play(now) {{\n"
                     "  show(Math.floor(now / 1000 * rate) % count);\n"
                     "  requestAnimationFrame(play);\n"
                     "}}\n"
                     "requestAnimationFrame(play);\n"
                     "]]></script>\n",
                     format_number(rate_hz), frames.rows(), script) +
         still.substr(end);
}

} // namespace phonomime
