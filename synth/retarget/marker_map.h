// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// Which vertex of the skin each marker of a layout sits on.
struct MarkerMap {
  std::vector<int> vertices;        // #groups, into the skin's vertices; -1 = not on this face
  bool automatic = false;           // made from the markers' names
  std::vector<std::string> missing; // layout's markers that the table does not place
  std::vector<std::string> unknown; // the table's markers that the layout does not have
};

// A line of a marker table.
struct MarkerPlace {
  std::string marker;
  int vertex = 0; // of the skin
  long line = 0;
};

// A tab-separated table with a header line that names the columns `marker` and `vertex` (others are
// passed over; `#` starts a comment): vertices counted from 0. `where` names it in errors.
// Throws InputError: a vertex out of range, a marker twice.
std::vector<MarkerPlace> parse_marker_table(std::string_view text, std::string_view where,
                                            int vertex_count);

// The same for a layout. Throws InputError, also for a vertex used twice and for fewer than 4
// markers of the layout.
MarkerMap parse_marker_map(std::string_view text, std::string_view where, const Layout& layout,
                           int vertex_count);

// The map that the names themselves give where each is one prefix and a number ("lm13" is vertex
// 13), all distinct and in range. Nothing where they are not.
std::optional<MarkerMap> marker_map_from_names(const Layout& layout, int vertex_count);

} // namespace phonomime
