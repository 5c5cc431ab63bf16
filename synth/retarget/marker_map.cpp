// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/marker_map.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <set>

namespace phonomime {
namespace {

constexpr std::size_t kFewestMarkers = 4;

struct Columns {
  std::size_t marker = 0;
  std::size_t vertex = 0;
};

Columns read_header(std::string_view line, const std::string& where) {
  const auto fields = split_fields(line, '\t');
  const auto column = [&](std::string_view name) {
    const auto found =
        std::ranges::find_if(fields, [&](auto field) { return trim(field) == name; });
    if (found == fields.end()) {
      throw InputError({.where = where,
                        .what = "the header line has no column " + quoted(name),
                        .expected = "marker<TAB>vertex",
                        .got = quoted(line)});
    }
    return static_cast<std::size_t>(found - fields.begin());
  };
  return {column("marker"), column("vertex")};
}

} // namespace

std::vector<MarkerPlace> parse_marker_table(std::string_view text, std::string_view where,
                                            int vertex_count) {
  std::vector<MarkerPlace> places;
  std::optional<Columns> columns;
  std::set<std::string, std::less<>> seen;
  long line_number = 0;
  for (const std::string_view line : split_lines(text)) {
    ++line_number;
    if (trim(line).empty() || line.front() == '#') {
      continue;
    }
    const std::string place = at_line(where, line_number);
    if (!columns) {
      columns = read_header(line, place);
      continue;
    }
    const auto fields = split_fields(line, '\t');
    if (fields.size() <= std::max(columns->marker, columns->vertex)) {
      throw InputError({.where = place,
                        .what = "the line has too few fields",
                        .expected = "as many as the header line",
                        .got = std::to_string(fields.size())});
    }
    const std::string marker(trim(fields[columns->marker]));
    const auto field = trim(fields[columns->vertex]);
    const std::optional<long> vertex = parse_integer(field);
    if (!vertex || *vertex < 0 || *vertex >= vertex_count) {
      throw InputError(
          {.where = place,
           .what = "marker " + quoted(marker) + " is on a vertex that the face does not have",
           .expected = "0 to " + std::to_string(vertex_count - 1),
           .got = quoted(field)});
    }
    if (!seen.insert(marker).second) {
      throw InputError({.where = place, .what = "marker " + quoted(marker) + " is placed twice"});
    }
    places.push_back({.marker = marker, .vertex = static_cast<int>(*vertex), .line = line_number});
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
