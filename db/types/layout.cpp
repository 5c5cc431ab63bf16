// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/layout.h"

#include "db/types/errors.h"
#include "db/types/json_file.h"
#include "db/types/text.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using nlohmann::json;

struct Direction {
  std::string_view name;
  std::size_t our_axis; // 0 right of the picture, 1 up, 2 towards the camera
  double sign;
};
constexpr std::array<Direction, 6> kDirections = {{{"right of the picture", 0, 1.0},
                                                   {"left of the picture", 0, -1.0},
                                                   {"up", 1, 1.0},
                                                   {"down", 1, -1.0},
                                                   {"towards the camera", 2, 1.0},
                                                   {"away from the camera", 2, -1.0}}};
constexpr std::array<std::string_view, 3> kAxisNames = {"x", "y", "z"};

double unit_in_mm(std::string_view unit) {
  return unit == "m" ? 1000.0 : unit == "cm" ? 10.0 : 1.0;
}

std::array<AxisSource, 3> parse_axes(const json& axes, std::string_view where) {
  std::array<AxisSource, 3> sources;
  std::array<std::string_view, 3> taken_by;
  for (std::size_t file_axis = 0; file_axis < 3; ++file_axis) {
    const std::string& name = axes.at(kAxisNames[file_axis]).get_ref<const std::string&>();
    const Direction& direction = *std::ranges::find(kDirections, name, &Direction::name);
    if (!taken_by[direction.our_axis].empty()) {
      throw InputError({.where = std::string(where),
                        .what = fmt::format("$.axes: {} and {} lie along the same direction",
                                            taken_by[direction.our_axis], kAxisNames[file_axis]),
                        .expected = "left or right, up or down, towards or away, each once",
                        .got = quoted(name)});
    }
    taken_by[direction.our_axis] = kAxisNames[file_axis];
    sources[direction.our_axis] = {.axis = static_cast<int>(file_axis), .sign = direction.sign};
  }
  return sources;
}

// A name becomes part of a CSV header and of messages.
bool is_group_name(std::string_view name) {
  return !name.empty() && trim(name) == name && std::ranges::none_of(name, [](char c) {
    return c == ',' || c == '"' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
  });
}

std::vector<ChannelGroup> parse_groups(const json& items, std::string_view where) {
  std::vector<ChannelGroup> groups;
  std::set<std::string_view> names;
  for (const json& item : items) {
    const std::string& name = item.at("name").get_ref<const std::string&>();
    const auto place = [&] { return fmt::format("$.groups[{}].name", groups.size()); };
    if (!is_group_name(name)) {
      throw InputError({.where = std::string(where),
                        .what = place() + " cannot be a group's name",
                        .expected = "text without commas, quotes, control characters and spaces "
                                    "at its ends",
                        .got = quoted(name)});
    }
    if (!names.insert(name).second) {
      throw InputError({.where = std::string(where),
                        .what = fmt::format("{}: there are two groups {}", place(), quoted(name)),
                        .remedy = "Name each channel group once."});
    }
    ChannelGroup group{.name = name, .regions = {}};
    for (const json& region : item.value("regions", json::array())) {
      const auto found = std::ranges::find(kRegionNames, region.get_ref<const std::string&>());
      group.regions.push_back(static_cast<Region>(found - kRegionNames.begin()));
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

void require_group(const Layout& layout, std::string_view name, std::string_view member,
                   std::string_view where) {
  if (layout.find_group(name)) {
    return;
  }
  std::vector<std::string> names;
  std::ranges::transform(layout.groups, std::back_inserter(names), &ChannelGroup::name);
  throw InputError({.where = std::string(where),
                    .what = fmt::format("{}: there is no group {}", member, quoted(name)),
                    .remedy = did_you_mean(name, names)});
}

void check_members_of_kind(const json& value, LayoutKind kind, std::string_view where) {
  const bool markers = kind == LayoutKind::markers;
  for (const char* member : {"unit", "axes"}) {
    if (markers && !value.contains(member)) {
      throw InputError({.where = std::string(where),
                        .what = fmt::format("a layout of markers needs {}", quoted(member)),
                        .remedy = "See corpora_schema/layout.md."});
    }
  }
  for (const char* member : {"unit", "axes", "scale", "reference", "landmarks"}) {
    if (!markers && value.contains(member)) {
      throw InputError({.where = std::string(where),
                        .what = fmt::format("a layout of weights has no {}", quoted(member)),
                        .remedy = "Remove it, or set \"kind\" to \"markers\"."});
    }
  }
}

} // namespace

bool ChannelGroup::in(Region region) const {
  return std::ranges::find(regions, region) != regions.end();
}

std::optional<int> Layout::find_group(std::string_view name) const {
  const auto found = std::ranges::find(groups, name, &ChannelGroup::name);
  if (found == groups.end()) {
    return std::nullopt;
  }
  return static_cast<int>(found - groups.begin());
}

std::optional<int> Layout::find_landmark(std::string_view landmark) const {
  const auto found = landmarks.find(landmark);
  return found == landmarks.end() ? std::nullopt : find_group(found->second);
}

std::vector<int> Layout::groups_in(Region region) const {
  std::vector<int> members;
  for (int i = 0; i < group_count(); ++i) {
    if (groups[static_cast<std::size_t>(i)].in(region)) {
      members.push_back(i);
    }
  }
  return members;
}

Layout parse_layout(std::string_view json_text, std::string_view where) {
  const json value = parse_json_as("layout", json_text, where);
  Layout layout;
  layout.kind = value.at("kind") == "markers" ? LayoutKind::markers : LayoutKind::weights;
  check_members_of_kind(value, layout.kind, where);
  layout.groups = parse_groups(value.at("groups"), where);
  if (layout.kind == LayoutKind::weights) {
    return layout;
  }
  layout.unit_mm = unit_in_mm(value.at("unit").get_ref<const std::string&>());
  layout.axes = parse_axes(value.at("axes"), where);
  if (value.contains("scale")) {
    layout.scale = value.at("scale") == "measured" ? Scale::measured : Scale::nominal;
  }
  layout.reference = value.value("reference", std::string());
  if (!layout.reference.empty()) {
    require_group(layout, layout.reference, "$.reference", where);
  }
  const json landmarks = value.value("landmarks", json::object());
  for (const auto& [landmark, group] : landmarks.items()) {
    layout.landmarks[landmark] = group.get<std::string>();
    require_group(layout, layout.landmarks[landmark], "$.landmarks." + landmark, where);
  }
  return layout;
}

std::string format_layout(const Layout& layout) {
  const bool markers = layout.kind == LayoutKind::markers;
  nlohmann::ordered_json value = {
      {"format", "phonomime-layout"}, {"version", 1}, {"kind", markers ? "markers" : "weights"}};
  if (markers) {
    value["unit"] = "mm";
    value["axes"] = {
        {"x", kDirections[0].name}, {"y", kDirections[2].name}, {"z", kDirections[4].name}};
    if (layout.scale) {
      value["scale"] = kScaleNames[static_cast<std::size_t>(*layout.scale)];
    }
    if (!layout.reference.empty()) {
      value["reference"] = layout.reference;
    }
  }
  nlohmann::ordered_json& groups = value["groups"] = nlohmann::ordered_json::array();
  for (const ChannelGroup& group : layout.groups) {
    nlohmann::ordered_json regions = nlohmann::ordered_json::array();
    for (const Region region : group.regions) {
      regions.push_back(kRegionNames[static_cast<std::size_t>(region)]);
    }
    groups.push_back({{"name", group.name}, {"regions", regions}});
  }
  if (markers && !layout.landmarks.empty()) {
    nlohmann::ordered_json& landmarks = value["landmarks"] = nlohmann::ordered_json::object();
    for (const auto& [landmark, group] : layout.landmarks) {
      landmarks[landmark] = group;
    }
  }
  return value.dump(1) + "\n";
}

} // namespace phonomime
