// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/unicode.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace phonomime {

namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
constexpr std::string_view kUtf16LittleMark = "\xFF\xFE";
constexpr std::string_view kUtf16BigMark = "\xFE\xFF";

void append_utf8(std::string& text, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | (code >> 6));
    put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | (code >> 18));
    put(0x80 | ((code >> 12) & 0x3F));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  }
}

// Nothing where the bytes are ill-formed: an odd count, a lone surrogate, a NUL.
std::optional<std::string> utf16_to_utf8(std::string_view bytes, bool big_endian) {
  if (bytes.size() % 2 != 0) {
    return std::nullopt;
  }
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800 && code <= 0xDBFF && i + 2 < bytes.size()) {
      const std::uint32_t low = unit(i + 2);
      if (low >= 0xDC00 && low <= 0xDFFF) {
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        i += 2;
      }
    }
    if (code == 0 || (code >= 0xD800 && code <= 0xDFFF)) {
      return std::nullopt;
    }
    append_utf8(text, code);
  }
  return text;
}

} // namespace

std::string decode_text(std::string_view bytes, std::string_view where) {
  const bool little = bytes.starts_with(kUtf16LittleMark);
  if (little || bytes.starts_with(kUtf16BigMark)) {
    std::optional<std::string> text = utf16_to_utf8(bytes.substr(2), !little);
    if (!text) {
      throw InputError({.where = std::string(where),
                        .what = "is marked as UTF-16 but is not well-formed UTF-16",
                        .remedy = "Save it again, as UTF-8."});
    }
    return *std::move(text);
  }
  if (bytes.starts_with(kUtf8Mark)) {
    bytes.remove_prefix(kUtf8Mark.size());
  }
  if (!is_valid_utf8(bytes)) {
    const bool has_nul = bytes.find('\0') != std::string_view::npos;
    throw InputError(
        {.where = std::string(where),
         .what = has_nul ? "is not a text file: it holds NUL bytes" : "is not well-formed UTF-8",
         .expected = "UTF-8, or UTF-16 with a byte order mark",
         .remedy = "Save it as UTF-8."});
  }
  return std::string(bytes);
}

} // namespace phonomime
