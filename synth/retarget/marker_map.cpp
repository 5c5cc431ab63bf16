// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/marker_map.h"

#include "db/types/errors.h"
#include "db/types/tab_table.h"
#include "db/types/text.h"

#include <array>
#include <set>

namespace phonomime {
namespace {

constexpr std::size_t kFewestMarkers = 4;

enum Column : std::size_t { marker, vertex };
constexpr std::array<std::string_view, 2> kColumns = {"marker", "vertex"};
constexpr std::array<std::size_t, 2> kRequired = {marker, vertex};

} // namespace

std::vector<MarkerPlace> parse_marker_table(std::string_view text, std::string_view where,
                                            int vertex_count) {
  TabTable table(text, where, kColumns, kRequired, {.comments = true, .other_columns = true});
  std::vector<MarkerPlace> places;
  std::set<std::string, std::less<>> seen;
  while (table.next()) {
    const std::string name(table.field(marker));
    const std::optional<long> place = parse_integer(table.field(vertex));
    if (!place || *place < 0 || *place >= vertex_count) {
      throw InputError(
          {.where = table.where(),
           .what = "marker " + quoted(name) + " is on a vertex that the face does not have",
           .expected = "0 to " + std::to_string(vertex_count - 1),
           .got = quoted(table.field(vertex))});
    }
    if (!seen.insert(name).second) {
      throw InputError(
          {.where = table.where(), .what = "marker " + quoted(name) + " is placed twice"});
    }
    places.push_back({.marker = name, .vertex = static_cast<int>(*place), .line = table.line()});
  }
  return places;
}

MarkerMap parse_marker_map(std::string_view text, std::string_view where, const Layout& layout,
                           int vertex_count) {
  MarkerMap map;
  map.vertices.assign(layout.groups.size(), -1);
  std::set<int> used;
  std::size_t known = 0;
  for (const MarkerPlace& place : parse_marker_table(text, where, vertex_count)) {
    const std::optional<int> group = layout.find_group(place.marker);
    if (!group) {
      map.unknown.push_back(place.marker);
      continue;
    }
    if (!used.insert(place.vertex).second) {
      throw InputError({.where = at_line(where, place.line),
                        .what = "two markers are on vertex " + std::to_string(place.vertex),
                        .remedy = "Give marker " + quoted(place.marker) + " a vertex of its own."});
    }
    map.vertices[static_cast<std::size_t>(*group)] = place.vertex;
    ++known;
  }
  if (known < kFewestMarkers) {
    throw InputError({.where = std::string(where),
                      .what = "the table places too few of the layout's markers",
                      .expected = "at least " + std::to_string(kFewestMarkers),
                      .got = std::to_string(known)});
  }
  for (std::size_t g = 0; g < map.vertices.size(); ++g) {
    if (map.vertices[g] < 0) {
      map.missing.push_back(layout.groups[g].name);
    }
  }
  return map;
}

std::optional<MarkerMap> marker_map_from_names(const Layout& layout, int vertex_count) {
  MarkerMap map;
  map.automatic = true;
  std::set<long> used;
  std::optional<std::string> prefix;
  for (const ChannelGroup& group : layout.groups) {
    const std::size_t digits = group.name.find_last_not_of("0123456789") + 1;
    const std::optional<long> vertex = parse_integer(std::string_view(group.name).substr(digits));
    if (!prefix) {
      prefix = group.name.substr(0, digits);
    }
    if (!vertex || *vertex >= vertex_count || !used.insert(*vertex).second ||
        group.name.compare(0, digits, *prefix) != 0) {
      return std::nullopt;
    }
    map.vertices.push_back(static_cast<int>(*vertex));
  }
  return map.vertices.size() < kFewestMarkers ? std::nullopt : std::optional(map);
}

} // namespace phonomime
