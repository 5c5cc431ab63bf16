// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/shape_names.h"

#include "db/types/live_link_columns.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace phonomime {
namespace {

// Lower case, without `_` and `-`.
std::string plain_name(std::string_view name) {
  std::string plain = to_lower(name);
  std::erase_if(plain, [](char letter) { return letter == '_' || letter == '-'; });
  return plain;
}

// The side that a name ends with, taken off.
std::pair<std::string, std::string_view> without_side(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kSides = {
      {{"left", "left"},
       {"right", "right"},
       {"_l", "left"},
       {"_r", "right"},
       {"-l", "left"},
       {"-r", "right"}}};
  const std::string lower = to_lower(name);
  for (const auto& [end, side] : kSides) {
    if (lower.size() > end.size() && lower.ends_with(end)) {
      return {plain_name(std::string_view(lower).substr(0, lower.size() - end.size())), side};
    }
  }
  return {plain_name(name), ""};
}

} // namespace

std::optional<std::size_t> arkit_shape(std::string_view name) {
  static const std::map<std::string, std::size_t, std::less<>> known = [] {
    std::map<std::string, std::size_t, std::less<>> shapes;
    for (std::size_t i = 0; i < kArkitShapeCount; ++i) {
      shapes.emplace(plain_name(kLiveLinkColumns[i]), i);
    }
    return shapes;
  }();
  const auto [stem, side] = without_side(name);
  for (const std::string& meant : {stem + std::string(side), stem}) {
    if (const auto found = known.find(meant); found != known.end()) {
      return found->second;
    }
  }
  return std::nullopt;
}

std::vector<std::size_t> matching_shapes(std::string_view name,
                                         std::span<const std::string> targets) {
  std::vector<std::size_t> found;
  const auto take = [&](auto fits) {
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (fits(targets[i])) {
        found.push_back(i);
      }
    }
    return !found.empty();
  };
  if (take([&](const std::string& target) { return target == name; })) {
    return found;
  }
  const std::string plain = plain_name(name);
  if (take([&](const std::string& target) { return plain_name(target) == plain; })) {
    return found;
  }
  if (const std::optional<std::size_t> shape = arkit_shape(name)) {
    take([&](const std::string& target) { return arkit_shape(target) == shape; });
  }
  return found;
}

} // namespace phonomime
