// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/channels.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

constexpr std::size_t kNamesShown = 5;

[[noreturn]] void fail(std::string_view where, std::string what, std::string expected,
                       std::string got, std::string remedy) {
  throw InputError({.where = std::string(where),
                    .what = std::move(what),
                    .expected = std::move(expected),
                    .got = std::move(got),
                    .remedy = std::move(remedy)});
}

std::string unit_name(double unit_mm) {
  return unit_mm == 1.0      ? "mm"
         : unit_mm == 10.0   ? "cm"
         : unit_mm == 1000.0 ? "m"
                             : format_number(unit_mm) + " mm";
}

void check_fits(const MotionClip& clip, const Layout& layout, std::string_view where) {
  if (clip.frame_count() == 0) {
    fail(where, "recording has no frames", "", "", "");
  }
  if (!(clip.rate_hz > 0.0) || !std::isfinite(clip.rate_hz)) {
    fail(where, "recording has no frame rate", "a positive number of frames a second",
         format_number(clip.rate_hz), "");
  }
  if (clip.channels_per_group != layout.channels_per_group()) {
    const auto kind = [](int channels) { return channels == 3 ? "markers" : "weights"; };
    fail(where, "recording is of another kind than the layout", kind(layout.channels_per_group()),
         kind(clip.channels_per_group), "Correct `kind` in the layout.");
  }
  const bool says_unit = layout.kind == LayoutKind::markers && clip.unit_mm > 0.0;
  if (says_unit && std::abs(clip.unit_mm - layout.unit_mm) > 1e-6 * layout.unit_mm) {
    fail(where, "recording is in another unit than the layout says", unit_name(layout.unit_mm),
         unit_name(clip.unit_mm), "Correct `unit` in the layout.");
  }
}

// Where each group of the layout is in the clip.
std::vector<int> find_groups(const MotionClip& clip, const Layout& layout, std::string_view where,
                             std::vector<std::string>& extra_groups) {
  std::map<std::string_view, int> in_file;
  for (std::size_t i = 0; i < clip.groups.size(); ++i) {
    const bool is_new = in_file.emplace(clip.groups[i], static_cast<int>(i)).second;
    const bool is_wanted = layout.find_group(clip.groups[i]).has_value();
    if (is_wanted && !is_new) {
      fail(where, fmt::format("recording has group {} twice", quoted(clip.groups[i])), "", "",
           "Rename one of them in the recording.");
    }
    if (!is_wanted && is_new) {
      extra_groups.push_back(clip.groups[i]);
    }
  }
  std::vector<int> found;
  std::vector<std::string> missing;
  for (const ChannelGroup& group : layout.groups) {
    const auto place = in_file.find(group.name);
    if (place == in_file.end()) {
      missing.push_back(quoted(group.name));
    } else {
      found.push_back(place->second);
    }
  }
  if (!missing.empty()) {
    const std::size_t count = missing.size();
    missing.resize(std::min(count, kNamesShown));
    const std::string_view first_missing = std::string_view(missing.front());
    fail(where,
         fmt::format("recording lacks {} of the layout's {} groups: {}{}", count,
                     layout.groups.size(), fmt::join(missing, ", "),
                     count > missing.size() ? ", ..." : ""),
         "", "", did_you_mean(first_missing.substr(1, first_missing.size() - 2), extra_groups));
  }
  return found;
}

} // namespace

LayoutMotion to_layout(const MotionClip& clip, const Layout& layout, std::string_view where) {
  check_fits(clip, layout, where);
  LayoutMotion result{.rate_hz = clip.rate_hz, .frames = {}, .extra_groups = {}};
  const std::vector<int> places = find_groups(clip, layout, where, result.extra_groups);
  const int width = layout.channels_per_group();
  result.frames.resize(clip.frame_count(), layout.channel_count());
  for (std::size_t group = 0; group < places.size(); ++group) {
    const Eigen::Index to = static_cast<Eigen::Index>(group) * width;
    const Eigen::Index from = static_cast<Eigen::Index>(places[group]) * width;
    for (int axis = 0; axis < width; ++axis) {
      if (layout.kind == LayoutKind::weights) {
        result.frames.col(to) = clip.frames.col(from).cast<double>();
      } else {
        const AxisSource source = layout.axes[static_cast<std::size_t>(axis)];
        result.frames.col(to + axis) =
            clip.frames.col(from + source.axis).cast<double>() * (source.sign * layout.unit_mm);
      }
    }
  }
  return result;
}

} // namespace phonomime
