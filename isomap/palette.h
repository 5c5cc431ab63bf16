// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// sRGB, 0 to 1.
struct Colour {
  double red = 0.0, green = 0.0, blue = 0.0;
  bool operator==(const Colour&) const = default;
};

inline constexpr Colour kWhite = {1.0, 1.0, 1.0};

// A colour of "#rrggbb". `where` names the place in errors. Throws InputError.
Colour parse_colour(std::string_view text, std::string_view where);

// "#rrggbb", rounded.
std::string format_colour(const Colour& colour);

// (1 - share) a + share b.
Colour mix(const Colour& a, const Colour& b, double share);

// A colour for each emotion: the one that is `chosen` for its name; else that of E Fig. 5 (black
// neutral, red anger, green sadness, blue happiness); else the next of a fixed row of others.
std::vector<Colour> palette_for(std::span<const std::string> emotions,
                                const std::map<std::string, Colour>& chosen = {});

} // namespace phonomime
