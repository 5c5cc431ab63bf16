// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/map_scene.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "isomap/map_legend.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>

namespace phonomime {

namespace {

constexpr double kMargin_px = 28.0;

void check_between(std::string_view name, double value, double least, double most) {
  if (!(value >= least && value <= most)) {
    throw InputError({.where = "map picture",
                      .what = std::string(name) + " is out of range",
                      .expected = format_number(least) + " to " + format_number(most),
                      .got = format_number(value)});
  }
}

void check_sizes(const MapPicture& picture) {
  const auto is_known = [&](std::int32_t emotion) {
    return emotion >= 0 && static_cast<std::size_t>(emotion) < picture.palette.size();
  };
  if (picture.palette.size() != picture.emotions.size() ||
      !std::all_of(picture.trajectories.begin(), picture.trajectories.end(),
                   [&](const MapTrajectory& t) { return is_known(t.emotion); })) {
    throw InternalError({.where = "map picture", .what = "emotions and palette do not fit"});
  }
}

// The head of an arrow at the end of a line. None where the line is no longer than a dot.
void add_arrow_head(const std::vector<Eigen::Vector2d>& line, double size_px, const Colour& colour,
                    double opacity, std::vector<Shape>& shapes) {
  const Eigen::Vector2d& tip = line.back();
  const auto from = std::find_if(line.rbegin(), line.rend(), [&](const Eigen::Vector2d& point) {
    return (tip - point).norm() >= 0.5 * size_px;
  });
  if (from == line.rend()) {
    return;
  }
  const Eigen::Vector2d along = (tip - *from).normalized() * size_px;
  const Eigen::Vector2d across(-0.4 * along.y(), 0.4 * along.x());
  shapes.emplace_back(Area{{tip, tip - along + across, tip - along - across}, colour, opacity});
}

void add_trajectory(const MapPicture& picture, const MapTrajectory& trajectory, const MapView& view,
                    double top_px, std::vector<Shape>& shapes) {
  const LineStyle style = style_of(trajectory.role);
  const Colour colour =
      style.colour.value_or(picture.palette[static_cast<std::size_t>(trajectory.emotion)]);
  std::vector<Eigen::Vector2d> points;
  for (Eigen::Index i = 0; i < trajectory.places.rows(); ++i) {
    points.push_back(view.to_px(trajectory.places(i, 0), trajectory.places(i, 1)) +
                     Eigen::Vector2d(0.0, top_px));
  }
  if (points.empty()) {
    return;
  }
  if (style.halo_px > 0.0) {
    shapes.emplace_back(Line{points, kWhite, style.width_px + 2.0 * style.halo_px, 0.85, false});
  }
  shapes.emplace_back(Line{points, colour, style.width_px, style.opacity, style.dashed});
  add_arrow_head(points, style.head_px, colour, style.head_opacity, shapes);
}

template <typename Role, typename Items>
std::vector<Role> roles_that_occur(const Items& items, std::span<const Role> all) {
  std::vector<Role> roles;
  std::copy_if(all.begin(), all.end(), std::back_inserter(roles), [&](Role role) {
    return std::any_of(items.begin(), items.end(),
                       [&](const auto& item) { return item.role == role; });
  });
  return roles;
}

} // namespace

void MapPictureOptions::validate() const {
  check_between("width_px", width_px, 64, 8192);
  check_between("height_px", height_px, 64, 8192);
  check_between("sigma_px", density.sigma_px, 0.5, 500);
  check_between("rho", density.rho, 0.0, std::nextafter(1.0, 0.0));
}

MapPictureView view_of(const MapPicture& picture, const MapPictureOptions& options) {
  options.validate();
  const double margin = kMargin_px + 2.0 * options.density.sigma_px;
  return {MapView(picture.places, options.width_px, options.height_px,
                  std::min(margin, 0.25 * std::min(options.width_px, options.height_px))),
          options.legend && !picture.title.empty() ? kTitleHeight_px : 0};
}

MapScene compose(const MapPicture& picture, const MapPictureOptions& options) {
  check_sizes(picture);
  const MapPictureView view = view_of(picture, options);
  MapScene scene;
  scene.width_px = options.width_px;
  scene.raster_top_px = view.top_px;
  scene.height_px = view.top_px + options.height_px;
  scene.raster =
      draw_density(picture.places, picture.emotion_of, picture.palette, view.map, options.density);

  const auto trajectory_roles =
      roles_that_occur<TrajectoryRole>(picture.trajectories, kTrajectoryRoles);
  for (const TrajectoryRole role : trajectory_roles) {
    Layer layer = {std::string(style_of(role).name), {}};
    for (const MapTrajectory& trajectory : picture.trajectories) {
      if (trajectory.role == role) {
        add_trajectory(picture, trajectory, view.map, view.top_px, layer.shapes);
      }
    }
    scene.layers.push_back(std::move(layer));
  }
  const auto mark_roles = roles_that_occur<MarkRole>(picture.marks, kMarkRoles);
  for (const MarkRole role : mark_roles) {
    Layer layer = {std::string(mark_name(role)), {}};
    for (const MapMark& mark : picture.marks) {
      if (mark.role == role) {
        add_mark(role, view.map.to_px(mark.x, mark.y) + Eigen::Vector2d(0.0, view.top_px),
                 layer.shapes);
      }
    }
    scene.layers.push_back(std::move(layer));
  }
  if (options.legend) {
    add_legend(picture, trajectory_roles, mark_roles, scene);
  }
  return scene;
}

} // namespace phonomime
