// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// Parts of a face. `rigid` groups move with the skull alone and carry the head pose.
enum class Region { lips, jaw, cheeks, nose, brows, eyelids, forehead, rigid };
inline constexpr std::array<std::string_view, 8> kRegionNames = {
    "lips", "jaw", "cheeks", "nose", "brows", "eyelids", "forehead", "rigid"};

enum class LayoutKind { markers, weights };

// Whether lengths can be believed. A single camera knows them up to a factor that changes as the
// head comes nearer; there every frame is brought to the size of the reference pose.
enum class Scale { measured, nominal };
inline constexpr std::array<std::string_view, 2> kScaleNames = {"measured", "nominal"};

// The unit of distance: a marker (3 channels, mm) or a blendshape weight (1 channel).
struct ChannelGroup {
  std::string name;
  std::vector<Region> regions;
  bool in(Region region) const;
};

// Where one of our axes comes from in the files: +1/-1 times the file's axis 0, 1 or 2.
struct AxisSource {
  int axis = 0;
  double sign = 1.0;
};

// What the channels of a corpus and of its database are. In memory and in the database markers are
// in mm, x to the right of the picture, y up, z towards the camera.
struct Layout {
  LayoutKind kind = LayoutKind::markers;
  double unit_mm = 1.0; // size of the files' unit (markers only)
  std::array<AxisSource, 3> axes = {{{0, 1.0}, {1, 1.0}, {2, 1.0}}};
  std::optional<Scale> scale; // markers only; empty: an import finds out
  std::string reference;      // reference marker; may be empty
  std::vector<ChannelGroup> groups;
  std::map<std::string, std::string, std::less<>> landmarks; // landmark -> group name

  int channels_per_group() const { return kind == LayoutKind::markers ? 3 : 1; }
  int group_count() const { return static_cast<int>(groups.size()); }
  int channel_count() const { return group_count() * channels_per_group(); }
  std::optional<int> find_group(std::string_view name) const;
  std::optional<int> find_landmark(std::string_view landmark) const; // index into groups
  std::vector<int> groups_in(Region region) const;
};

// The layout of a layout.json's text, checked against the schema and for repeated or missing names.
// `where` names the file in errors. Throws InputError.
Layout parse_layout(std::string_view json_text, std::string_view where);

// The text that parse_layout reads back as the same layout (in mm and in our axes).
std::string format_layout(const Layout& layout);

} // namespace phonomime
