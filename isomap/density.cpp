// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/density.h"

#include "db/types/errors.h"
#include "db/types/parallel_for.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

constexpr int kRowsAtOnce = 16; // a thread's share
constexpr double kReach = 4.0;  // in sigma

// exp(-t) for t from 0 to 8, to 1e-11 of its value, of additions and multiplications alone: the C
// library's takes another path on machines with fused multiply-add.
double exp_minus(double t) {
  const double r = t / 64.0;
  double value = 1.0;
  for (int term = 8; term > 0; --term) {
    value = 1.0 - r / term * value;
  }
  for (int doubling = 0; doubling < 6; ++doubling) {
    value *= value;
  }
  return value;
}

double gaussian(double offset_px, double sigma_px) {
  const double u = offset_px / sigma_px;
  return std::abs(u) < kReach ? exp_minus(0.5 * u * u) : 0.0;
}

// Sums of Gaussians without rho: pixel by emotion.
class Densities {
public:
  Densities(const MapView& view, std::size_t emotions)
      : width_(view.width_px()), height_(view.height_px()), emotions_(emotions),
        sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * emotions) {}

  std::span<double> at(int x, int y) {
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x);
    return std::span(sums_).subspan(pixel * emotions_, emotions_);
  }
  double total(int x, int y) {
    double sum = 0.0;
    for (const double density : at(x, y)) {
      sum += density;
    }
    return sum;
  }

  // Rows [top, bottom) of one frame's Gaussian about a place in pixels.
  void add(const Eigen::Vector2d& place, std::size_t emotion, double sigma_px, int top,
           int bottom) {
    const double reach = kReach * sigma_px;
    top = std::max(top, static_cast<int>(std::floor(place.y() - reach)));
    bottom = std::min(bottom, static_cast<int>(std::ceil(place.y() + reach)));
    if (top >= bottom) {
      return;
    }
    const int left = std::max(0, static_cast<int>(std::floor(place.x() - reach)));
    const int right = std::min(width_, static_cast<int>(std::ceil(place.x() + reach)));
    std::vector<double> across;
    for (int x = left; x < right; ++x) {
      across.push_back(gaussian(x + 0.5 - place.x(), sigma_px));
    }
    for (int y = top; y < bottom; ++y) {
      const double down = gaussian(y + 0.5 - place.y(), sigma_px);
      for (int x = left; x < right; ++x) {
        at(x, y)[emotion] += down * across[static_cast<std::size_t>(x - left)];
      }
    }
  }

private:
  int width_, height_;
  std::size_t emotions_;
  std::vector<double> sums_;
};

// The rho that leaves kUsualInk at the median frame, under 1.
double usual_rho(Densities& densities, const std::vector<Eigen::Vector2d>& places) {
  std::vector<double> totals;
  for (const Eigen::Vector2d& place : places) {
    totals.push_back(densities.total(static_cast<int>(place.x()), static_cast<int>(place.y())));
  }
  if (totals.empty()) {
    return kUsualInk;
  }
  const auto middle = totals.begin() + static_cast<std::ptrdiff_t>(totals.size() / 2);
  std::nth_element(totals.begin(), middle, totals.end());
  return kUsualInk / std::max(1.0, *middle);
}

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5);
}

} // namespace

Raster draw_density(const MapPlaces& places, std::span<const std::int32_t> emotion_of,
                    std::span<const Colour> palette, const MapView& view,
                    const DensityOptions& options) {
  const auto is_known = [&](std::int32_t emotion) {
    return emotion >= 0 && static_cast<std::size_t>(emotion) < palette.size();
  };
  if (emotion_of.size() != static_cast<std::size_t>(places.rows()) ||
      !std::all_of(emotion_of.begin(), emotion_of.end(), is_known)) {
    throw InternalError({.where = "map density", .what = "places and emotions do not fit"});
  }
  std::vector<Eigen::Vector2d> px;
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    px.push_back(view.to_px(places(i, 0), places(i, 1)));
  }
  Densities densities(view, palette.size());
  parallel_for((view.height_px() + kRowsAtOnce - 1) / kRowsAtOnce, options.threads,
               [&](std::ptrdiff_t share) {
                 const int top = static_cast<int>(share) * kRowsAtOnce;
                 const int bottom = std::min(top + kRowsAtOnce, view.height_px());
                 for (std::size_t i = 0; i < px.size(); ++i) {
                   densities.add(px[i], static_cast<std::size_t>(emotion_of[i]), options.sigma_px,
                                 top, bottom);
                 }
               });
  const double rho = options.rho > 0.0 ? options.rho : usual_rho(densities, px);

  Raster raster = {view.width_px(), view.height_px(), {}};
  raster.bytes.reserve(static_cast<std::size_t>(view.width_px()) *
                       static_cast<std::size_t>(view.height_px()) * 3);
  for (int y = 0; y < view.height_px(); ++y) {
    for (int x = 0; x < view.width_px(); ++x) {
      const std::span<const double> density = densities.at(x, y);
      const double total = densities.total(x, y);
      Colour colour = {};
      for (std::size_t e = 0; e < palette.size() && total > 0.0; ++e) {
        const double share = density[e] / total;
        colour.red += share * palette[e].red;
        colour.green += share * palette[e].green;
        colour.blue += share * palette[e].blue;
      }
      const Colour shown = mix(kWhite, colour, std::min(1.0, rho * total));
      for (const double value : {shown.red, shown.green, shown.blue}) {
        raster.bytes.push_back(to_byte(value));
      }
    }
  }
  return raster;
}

} // namespace phonomime
