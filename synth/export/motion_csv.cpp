// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/motion_csv.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace phonomime {
namespace {

// Live Link Face's order: ARKit's 52 shapes, then the rotations.
constexpr std::size_t kShapes = 52;
constexpr std::array<std::string_view, 61> kLiveLinkNames = {"EyeBlinkLeft",
                                                             "EyeLookDownLeft",
                                                             "EyeLookInLeft",
                                                             "EyeLookOutLeft",
                                                             "EyeLookUpLeft",
                                                             "EyeSquintLeft",
                                                             "EyeWideLeft",
                                                             "EyeBlinkRight",
                                                             "EyeLookDownRight",
                                                             "EyeLookInRight",
                                                             "EyeLookOutRight",
                                                             "EyeLookUpRight",
                                                             "EyeSquintRight",
                                                             "EyeWideRight",
                                                             "JawForward",
                                                             "JawRight",
                                                             "JawLeft",
                                                             "JawOpen",
                                                             "MouthClose",
                                                             "MouthFunnel",
                                                             "MouthPucker",
                                                             "MouthRight",
                                                             "MouthLeft",
                                                             "MouthSmileLeft",
                                                             "MouthSmileRight",
                                                             "MouthFrownLeft",
                                                             "MouthFrownRight",
                                                             "MouthDimpleLeft",
                                                             "MouthDimpleRight",
                                                             "MouthStretchLeft",
                                                             "MouthStretchRight",
                                                             "MouthRollLower",
                                                             "MouthRollUpper",
                                                             "MouthShrugLower",
                                                             "MouthShrugUpper",
                                                             "MouthPressLeft",
                                                             "MouthPressRight",
                                                             "MouthLowerDownLeft",
                                                             "MouthLowerDownRight",
                                                             "MouthUpperUpLeft",
                                                             "MouthUpperUpRight",
                                                             "BrowDownLeft",
                                                             "BrowDownRight",
                                                             "BrowInnerUp",
                                                             "BrowOuterUpLeft",
                                                             "BrowOuterUpRight",
                                                             "CheekPuff",
                                                             "CheekSquintLeft",
                                                             "CheekSquintRight",
                                                             "NoseSneerLeft",
                                                             "NoseSneerRight",
                                                             "TongueOut",
                                                             "HeadYaw",
                                                             "HeadPitch",
                                                             "HeadRoll",
                                                             "LeftEyeYaw",
                                                             "LeftEyePitch",
                                                             "LeftEyeRoll",
                                                             "RightEyeYaw",
                                                             "RightEyePitch",
                                                             "RightEyeRoll"};

// For each of Live Link's values, the layout's group, -1 = the layout lacks it. Empty where the
// layout is not ARKit's.
std::vector<int> live_link_groups(const Layout& layout) {
  if (layout.kind != LayoutKind::weights ||
      (layout.groups.size() != kShapes && layout.groups.size() != kLiveLinkNames.size())) {
    return {};
  }
  std::vector<int> groups(kLiveLinkNames.size(), -1);
  for (int g = 0; g < layout.group_count(); ++g) {
    const std::string name = to_lower(layout.groups[static_cast<std::size_t>(g)].name);
    const auto found =
        std::ranges::find_if(kLiveLinkNames, [&](auto known) { return to_lower(known) == name; });
    if (found == kLiveLinkNames.end()) {
      return {};
    }
    groups[static_cast<std::size_t>(found - kLiveLinkNames.begin())] = g;
  }
  return std::ranges::count(groups.begin(), groups.begin() + kShapes, -1) == 0 ? groups
                                                                               : std::vector<int>();
}

void check(const Layout& layout, LayoutKind kind, double rate_hz, const FrameMatrixD& frames) {
  if (layout.kind != kind || frames.cols() != layout.channel_count() || !(rate_hz > 0.0) ||
      !frames.allFinite()) {
    throw InternalError({.what = "motion and layout do not belong together"});
  }
  for (const ChannelGroup& group : layout.groups) {
    if (group.name.find_first_of(",\"\r\n") != std::string::npos) {
      throw UsageError({.what = "the name " + quoted(group.name) + " cannot stand in a CSV header",
                        .remedy = "Give the group a name without commas and quotes."});
    }
  }
}

// A number rounded to `digits` decimals; never "-0.000".
void append_number(std::string& text, double value, int digits) {
  const double unit = std::pow(10.0, digits);
  if (std::abs(value) * unit < 0.5) {
    value = 0.0;
  }
  fmt::format_to(std::back_inserter(text), "{:.{}f}", value, digits);
}

void append_time(std::string& text, Eigen::Index frame, double rate_hz) {
  append_number(text, static_cast<double>(frame) / rate_hz, 6);
}

// HH:MM:SS:FF.fff, FF in sixtieths of a second.
std::string timecode(Eigen::Index frame, double rate_hz) {
  const long long thousandths = std::llround(static_cast<double>(frame) / rate_hz * 60.0 * 1000.0);
  const long long ticks = thousandths / 1000;
  const long long seconds = ticks / 60;
  return fmt::format("{:02}:{:02}:{:02}:{:02}.{:03}", seconds / 3600 % 24, seconds / 60 % 60,
                     seconds % 60, ticks % 60, thousandths % 1000);
}

} // namespace

std::string format_marker_csv(const Layout& layout, double rate_hz, const FrameMatrixD& channels,
                              std::span<const HeadPose> head) {
  check(layout, LayoutKind::markers, rate_hz, channels);
  if (!head.empty() && static_cast<Eigen::Index>(head.size()) != channels.rows()) {
    throw InternalError({.what = "head poses and frames differ in number"});
  }
  std::string text = "time";
  for (const ChannelGroup& group : layout.groups) {
    text += fmt::format(",{0}_x,{0}_y,{0}_z", group.name);
  }
  text += '\n';
  for (Eigen::Index k = 0; k < channels.rows(); ++k) {
    append_time(text, k, rate_hz);
    for (Eigen::Index g = 0; g < layout.group_count(); ++g) {
      Eigen::Vector3d marker = channels.row(k).segment<3>(3 * g).transpose();
      if (!head.empty()) {
        const HeadPose& pose = head[static_cast<std::size_t>(k)];
        marker = pose.rotation * marker + pose.translation_mm;
      }
      for (const double value : marker) {
        text += ',';
        append_number(text, value, 4);
      }
    }
    text += '\n';
  }
  return text;
}

std::string format_weight_csv(const Layout& layout, double rate_hz, const FrameMatrixD& weights) {
  check(layout, LayoutKind::weights, rate_hz, weights);
  const std::vector<int> live_link = live_link_groups(layout);
  std::string text = live_link.empty() ? "time" : "Timecode,BlendShapeCount";
  if (live_link.empty()) {
    for (const ChannelGroup& group : layout.groups) {
      text += "," + group.name;
    }
  }
  for (std::size_t i = 0; i < live_link.size(); ++i) {
    text += ',';
    text += kLiveLinkNames[i];
  }
  text += '\n';
  for (Eigen::Index k = 0; k < weights.rows(); ++k) {
    if (live_link.empty()) {
      append_time(text, k, rate_hz);
      for (Eigen::Index g = 0; g < weights.cols(); ++g) {
        text += ',';
        append_number(text, weights(k, g), 10);
      }
    } else {
      text += fmt::format("{},{}", timecode(k, rate_hz), kLiveLinkNames.size());
      for (const int group : live_link) {
        text += ',';
        append_number(text, group < 0 ? 0.0 : weights(k, group), 10);
      }
    }
    text += '\n';
  }
  return text;
}

bool is_live_link_layout(const Layout& layout) {
  return !live_link_groups(layout).empty();
}

} // namespace phonomime
