// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/map_view.h"

#include <algorithm>

namespace phonomime {

MapView::MapView(const MapPlaces& places, int width_px, int height_px, double margin_px)
    : width_px_(width_px), height_px_(height_px) {
  Eigen::Vector2d extent = Eigen::Vector2d::Zero();
  if (places.rows() > 0) {
    const Eigen::Vector2d least = places.colwise().minCoeff();
    const Eigen::Vector2d most = places.colwise().maxCoeff();
    middle_ = 0.5 * (least + most);
    extent = most - least;
  }
  if (extent.maxCoeff() <= 0.0) {
    extent.setOnes();
  }
  const double width = std::max(1.0, width_px - 2.0 * margin_px);
  const double height = std::max(1.0, height_px - 2.0 * margin_px);
  px_per_unit_ =
      extent.y() * width > extent.x() * height ? height / extent.y() : width / extent.x();
}

Eigen::Vector2d MapView::to_px(double x, double y) const {
  return {0.5 * width_px_ + (x - middle_.x()) * px_per_unit_,
          0.5 * height_px_ - (y - middle_.y()) * px_per_unit_};
}

Eigen::Vector2d MapView::to_map(double x_px, double y_px) const {
  return {middle_.x() + (x_px - 0.5 * width_px_) / px_per_unit_,
          middle_.y() - (y_px - 0.5 * height_px_) / px_per_unit_};
}

} // namespace phonomime
