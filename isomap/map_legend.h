// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "isomap/map_scene.h"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace phonomime {

inline constexpr int kTitleHeight_px = 36;

// All roles, in the order in which they are drawn.
inline constexpr std::array<TrajectoryRole, 5> kTrajectoryRoles = {
    TrajectoryRole::node, TrajectoryRole::pruned, TrajectoryRole::suspect,
    TrajectoryRole::context_correct, TrajectoryRole::chosen};
inline constexpr std::array<MarkRole, 4> kMarkRoles = {
    MarkRole::time_correct, MarkRole::context_correct, MarkRole::chosen, MarkRole::picked};

// How a trajectory looks.
struct LineStyle {
  std::string_view name;        // in the legend
  std::optional<Colour> colour; // nothing: the emotion's
  double width_px = 1.0, opacity = 1.0;
  double halo_px = 0.0; // white on both sides
  double head_px = 6.0; // the arrow's
  double head_opacity = 1.0;
  bool dashed = false;
};
LineStyle style_of(TrajectoryRole role);
std::string_view mark_name(MarkRole role);

void add_mark(MarkRole role, const Eigen::Vector2d& at_px, std::vector<Shape>& shapes);

// The title above the map and the legend below it; the scene grows by its height.
void add_legend(const MapPicture& picture, std::span<const TrajectoryRole> trajectories,
                std::span<const MarkRole> marks, MapScene& scene);

} // namespace phonomime
