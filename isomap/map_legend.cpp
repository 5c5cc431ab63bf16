// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/map_legend.h"

#include <utility>

namespace phonomime {

namespace {

constexpr Colour kInk = {0.1, 0.1, 0.12};
constexpr Colour kChosen = {0.85, 0.05, 0.60};
constexpr Colour kSuspect = {1.0, 0.50, 0.0};
constexpr Colour kPruned = {0.45, 0.45, 0.48};
constexpr Colour kRecommended = {1.0, 0.85, 0.1};

constexpr double kRowHeight_px = 26.0;
constexpr double kSide_px = 24.0;
constexpr double kTextSize_px = 14.0;
constexpr double kKeyWidth_px = 26.0;

// What the texts take about, as no font is at hand here.
double text_width(std::string_view text) {
  return 0.58 * kTextSize_px * static_cast<double>(text.size());
}

std::vector<Eigen::Vector2d> square_about(const Eigen::Vector2d& at, double half_px, bool on_tip) {
  std::vector<Eigen::Vector2d> corners;
  for (const auto& [x, y] :
       {std::pair{-1.0, -1.0}, std::pair{1.0, -1.0}, std::pair{1.0, 1.0}, std::pair{-1.0, 1.0}}) {
    corners.push_back(at + half_px * (on_tip ? Eigen::Vector2d(x + y, y - x) * 0.5 * 1.4
                                             : Eigen::Vector2d(x, y)));
  }
  return corners;
}

// Entries from left to right, in as many rows as they take.
class LegendRows {
public:
  LegendRows(const MapScene& scene) : width_(scene.width_px), top_(scene.height_px) {}

  // The middle of the entry's key; its text goes into `layer`.
  Eigen::Vector2d place(std::string_view text, Layer& layer) {
    const double width = kKeyWidth_px + 8.0 + text_width(text) + 22.0;
    if (x_ > kSide_px && x_ + width > width_ - kSide_px) {
      x_ = kSide_px;
      ++row_;
    }
    const Eigen::Vector2d middle(x_ + 0.5 * kKeyWidth_px, top_ + (row_ + 0.5) * kRowHeight_px);
    layer.shapes.emplace_back(Label{{x_ + kKeyWidth_px + 8.0, middle.y() + 0.35 * kTextSize_px},
                                    std::string(text),
                                    kTextSize_px});
    x_ += width;
    return middle;
  }
  int height_px() const { return static_cast<int>((row_ + 1) * kRowHeight_px + 10.0); }

private:
  double width_, top_;
  double x_ = kSide_px;
  int row_ = 0;
};

} // namespace

LineStyle style_of(TrajectoryRole role) {
  switch (role) {
  case TrajectoryRole::pruned:
    return {.name = "pruned", .colour = kPruned, .width_px = 1.5, .halo_px = 1.0, .dashed = true};
  case TrajectoryRole::suspect:
    return {
        .name = "suspect", .colour = kSuspect, .width_px = 2.0, .halo_px = 1.0, .head_px = 10.0};
  case TrajectoryRole::context_correct:
    return {.name = "same triphone", .width_px = 2.0, .halo_px = 1.5, .head_px = 10.0};
  case TrajectoryRole::chosen:
    return {.name = "chosen", .colour = kChosen, .width_px = 3.0, .halo_px = 1.5, .head_px = 13.0};
  case TrajectoryRole::node:
    break;
  }
  return {
      .name = "motion node", .width_px = 0.7, .opacity = 0.45, .head_px = 6.0, .head_opacity = 0.7};
}

std::string_view mark_name(MarkRole role) {
  switch (role) {
  case MarkRole::context_correct:
    return "same triphone, at this time";
  case MarkRole::chosen:
    return "chosen, at this time";
  case MarkRole::picked:
    return "picked";
  case MarkRole::time_correct:
    break;
  }
  return "at this time";
}

void add_mark(MarkRole role, const Eigen::Vector2d& at_px, std::vector<Shape>& shapes) {
  switch (role) {
  case MarkRole::time_correct:
    shapes.emplace_back(Disc{at_px, 3.2, kWhite, kInk, 1.4});
    break;
  case MarkRole::context_correct:
    shapes.emplace_back(Disc{at_px, 5.5, kRecommended, kInk, 1.5});
    break;
  case MarkRole::chosen:
    shapes.emplace_back(Area{square_about(at_px, 9.5, true), kWhite, 1.0});
    shapes.emplace_back(Area{square_about(at_px, 7.5, true), kChosen, 1.0});
    break;
  case MarkRole::picked:
    for (const auto& [colour, width_px] : {std::pair{kWhite, 5.0}, std::pair{kInk, 2.0}}) {
      for (const Eigen::Vector2d& arm : {Eigen::Vector2d(9.0, 0.0), Eigen::Vector2d(0.0, 9.0)}) {
        shapes.emplace_back(Line{{at_px - arm, at_px + arm}, colour, width_px, 1.0, false});
      }
    }
    break;
  }
}

void add_legend(const MapPicture& picture, std::span<const TrajectoryRole> trajectories,
                std::span<const MarkRole> marks, MapScene& scene) {
  Layer layer = {"legend", {}};
  if (!picture.title.empty()) {
    layer.shapes.emplace_back(Label{{kSide_px, 0.68 * kTitleHeight_px}, picture.title, 18.0});
  }
  LegendRows rows(scene);
  for (std::size_t e = 0; e < picture.emotions.size(); ++e) {
    const Eigen::Vector2d at = rows.place(picture.emotions[e], layer);
    layer.shapes.emplace_back(Area{square_about(at, 7.0, false), picture.palette[e], 1.0});
  }
  for (const TrajectoryRole role : trajectories) {
    const LineStyle style = style_of(role);
    const Eigen::Vector2d at = rows.place(style.name, layer);
    const Eigen::Vector2d half(0.5 * kKeyWidth_px, 0.0);
    const Eigen::Vector2d head(-style.head_px, 0.4 * style.head_px);
    const Colour colour = style.colour.value_or(kInk);
    layer.shapes.emplace_back(
        Line{{at - half, at + half}, colour, style.width_px, 1.0, style.dashed});
    layer.shapes.emplace_back(Area{
        {at + half, at + half + head, at + half + head.cwiseProduct(Eigen::Vector2d(1.0, -1.0))},
        colour,
        1.0});
  }
  for (const MarkRole role : marks) {
    add_mark(role, rows.place(mark_name(role), layer), layer.shapes);
  }
  scene.height_px += rows.height_px();
  scene.layers.push_back(std::move(layer));
}

} // namespace phonomime
