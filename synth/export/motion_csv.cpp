// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/motion_csv.h"

#include "db/types/errors.h"
#include "db/types/live_link_columns.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>

namespace phonomime {

namespace {

// Six decimals hold a frame's time to a microsecond at any rate.
double frame_time_s(const CoefficientMotion& motion, std::int64_t frame) {
  return static_cast<double>(frame) / motion.rate_hz;
}

Eigen::VectorXd frame_channels(const PcaModel& pca, const CoefficientMotion& motion,
                               Eigen::Index frame) {
  return pca.reconstruct(motion.coefficients.row(frame).transpose());
}

// Without "-0.0000", which differs from "0.0000" for no reader's good.
void append_decimal(std::string& text, double value, int decimals) {
  const std::size_t begin = text.size();
  fmt::format_to(std::back_inserter(text), "{:.{}f}", value, decimals);
  if (text[begin] == '-' && text.find_first_not_of("-0.", begin) == std::string::npos) {
    text.erase(begin, 1);
  }
}

// HH:MM:SS:FF.mmm with 60 ticks a second.
std::string timecode(double time_s) {
  constexpr long kTicks = 60;
  const long thousandths = std::lround(time_s * kTicks * 1000.0);
  const long ticks = thousandths / 1000;
  const long seconds = ticks / kTicks;
  return fmt::format("{:02}:{:02}:{:02}:{:02}.{:03}", seconds / 3600 % 24, seconds / 60 % 60,
                     seconds % 60, ticks % kTicks, thousandths % 1000);
}

constexpr std::span<const std::string_view> kLiveLinkShapeColumns =
    std::span(kLiveLinkColumns).first(kArkitShapeCount);

std::string marker_header(const Layout& layout) {
  std::string text = "time";
  for (const ChannelGroup& group : layout.groups) {
    text += fmt::format(",{0}_x,{0}_y,{0}_z", group.name);
  }
  return text + '\n';
}

std::string marker_rows(const Layout& layout, const PcaModel& pca, const CoefficientMotion& motion,
                        bool head, std::int64_t first_frame) {
  std::string text;
  for (Eigen::Index frame = 0; frame < motion.coefficients.rows(); ++frame) {
    append_decimal(text, frame_time_s(motion, first_frame + frame), 6);
    const Eigen::VectorXd channels = frame_channels(pca, motion, frame);
    for (int group = 0; group < layout.group_count(); ++group) {
      Eigen::Vector3d marker = channels.segment<3>(3 * group);
      if (head && !motion.head.empty()) {
        const HeadPose& pose = motion.head[static_cast<std::size_t>(frame)];
        marker = pose.rotation * marker + pose.translation_mm;
      }
      for (const double value : marker) {
        text += ',';
        append_decimal(text, value, 4);
      }
    }
    text += '\n';
  }
  return text;
}

std::string weight_header(const Layout& layout) {
  std::string text = "time";
  for (const ChannelGroup& group : layout.groups) {
    text += "," + group.name;
  }
  return text + '\n';
}

std::string weight_rows(const PcaModel& pca, const CoefficientMotion& motion,
                        std::int64_t first_frame) {
  std::string text;
  for (Eigen::Index frame = 0; frame < motion.coefficients.rows(); ++frame) {
    append_decimal(text, frame_time_s(motion, first_frame + frame), 6);
    for (const double value : frame_channels(pca, motion, frame)) {
      text += ',';
      append_decimal(text, value, 6);
    }
    text += '\n';
  }
  return text;
}

std::string live_link_header() {
  std::string text = "Timecode,BlendShapeCount";
  for (const std::string_view column : kLiveLinkColumns) {
    text += fmt::format(",{}", column);
  }
  return text + '\n';
}

std::string live_link_rows(const Layout& layout, const PcaModel& pca,
                           const CoefficientMotion& motion, std::int64_t first_frame) {
  std::string text;
  for (Eigen::Index frame = 0; frame < motion.coefficients.rows(); ++frame) {
    text += fmt::format("{},{}", timecode(frame_time_s(motion, first_frame + frame)),
                        kLiveLinkColumns.size());
    const Eigen::VectorXd channels = frame_channels(pca, motion, frame);
    for (std::size_t i = 0; i < kLiveLinkColumns.size(); ++i) {
      const std::optional<int> group = layout.find_group(kLiveLinkColumns[i]);
      const double value = group ? channels[*group] : 0.0;
      text += ',';
      // What the PCA leaves over can put a shape a little outside of its range; angles have none.
      append_decimal(text, i < kArkitShapeCount ? std::clamp(value, 0.0, 1.0) : value, 10);
    }
    text += '\n';
  }
  return text;
}

} // namespace

std::string marker_csv(const Layout& layout, const PcaModel& pca, const CoefficientMotion& motion,
                       bool head) {
  return marker_header(layout) + marker_rows(layout, pca, motion, head, 0);
}

std::string weight_csv(const Layout& layout, const PcaModel& pca, const CoefficientMotion& motion) {
  return weight_header(layout) + weight_rows(pca, motion, 0);
}

bool is_live_link_layout(const Layout& layout) {
  const auto known = [](const ChannelGroup& group) {
    return std::ranges::find(kLiveLinkColumns, group.name) != kLiveLinkColumns.end();
  };
  return layout.kind == LayoutKind::weights && std::ranges::all_of(layout.groups, known) &&
         std::ranges::all_of(kLiveLinkShapeColumns, [&](std::string_view shape) {
           return layout.find_group(shape).has_value();
         });
}

std::string live_link_csv(const Layout& layout, const PcaModel& pca,
                          const CoefficientMotion& motion) {
  if (!is_live_link_layout(layout)) {
    throw InternalError({.what = "the layout's groups are not Live Link Face's columns"});
  }
  return live_link_header() + live_link_rows(layout, pca, motion, 0);
}

std::string motion_csv_header(const Layout& layout) {
  if (layout.kind == LayoutKind::markers) {
    return marker_header(layout);
  }
  return is_live_link_layout(layout) ? live_link_header() : weight_header(layout);
}

std::string motion_csv_rows(const Layout& layout, const PcaModel& pca,
                            const CoefficientMotion& motion, bool head, std::int64_t first_frame) {
  if (layout.kind == LayoutKind::markers) {
    return marker_rows(layout, pca, motion, head, first_frame);
  }
  return is_live_link_layout(layout) ? live_link_rows(layout, pca, motion, first_frame)
                                     : weight_rows(pca, motion, first_frame);
}

} // namespace phonomime
