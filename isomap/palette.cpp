// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/palette.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr Colour of_bytes(int red, int green, int blue) {
  return {red / 255.0, green / 255.0, blue / 255.0};
}

struct NamedColour {
  std::string_view emotion;
  Colour colour;
};
constexpr std::array<NamedColour, 4> kUsual = {{{"neutral", of_bytes(0, 0, 0)},
                                                {"anger", of_bytes(214, 30, 36)},
                                                {"sadness", of_bytes(26, 145, 50)},
                                                {"happiness", of_bytes(26, 80, 220)}}};
constexpr std::array<Colour, 8> kOthers = {
    of_bytes(222, 125, 10), of_bytes(135, 60, 175), of_bytes(10, 150, 160), of_bytes(140, 85, 60),
    of_bytes(215, 95, 175), of_bytes(140, 145, 0),  of_bytes(90, 120, 150), of_bytes(120, 20, 60)};

int hex_digit(char c) {
  if (c >= '0' && c <= '9') {
    return c - '0';
  }
  const char lower = static_cast<char>(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

int to_byte(double value) {
  return static_cast<int>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
}

} // namespace

Colour parse_colour(std::string_view text, std::string_view where) {
  const bool is_colour =
      text.size() == 7 && text[0] == '#' &&
      std::all_of(text.begin() + 1, text.end(), [](char c) { return hex_digit(c) >= 0; });
  if (!is_colour) {
    throw InputError({.where = std::string(where),
                      .what = "this is no colour",
                      .expected = "#rrggbb, two hexadecimal digits each for red, green and blue",
                      .got = quoted(text)});
  }
  const auto byte = [&](std::size_t i) { return 16 * hex_digit(text[i]) + hex_digit(text[i + 1]); };
  return of_bytes(byte(1), byte(3), byte(5));
}

std::string format_colour(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", to_byte(colour.red), to_byte(colour.green),
                     to_byte(colour.blue));
}

Colour mix(const Colour& a, const Colour& b, double share) {
  return {(1.0 - share) * a.red + share * b.red, (1.0 - share) * a.green + share * b.green,
          (1.0 - share) * a.blue + share * b.blue};
}

std::vector<Colour> palette_for(std::span<const std::string> emotions,
                                const std::map<std::string, Colour>& chosen) {
  std::vector<Colour> palette;
  std::size_t others = 0;
  for (const std::string& emotion : emotions) {
    const auto of_user = chosen.find(emotion);
    const auto* usual = std::find_if(kUsual.begin(), kUsual.end(), [&](const NamedColour& named) {
      return named.emotion == emotion;
    });
    if (of_user != chosen.end()) {
      palette.push_back(of_user->second);
    } else if (usual != kUsual.end()) {
      palette.push_back(usual->colour);
    } else {
      palette.push_back(kOthers[others++ % kOthers.size()]);
    }
  }
  return palette;
}

} // namespace phonomime
