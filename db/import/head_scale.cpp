// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/head_scale.h"

#include "db/types/errors.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace phonomime {

namespace {

// More than markers on skin slide, less than a head moves before a camera.
constexpr double kMostMeasuredVariation = 0.01;

} // namespace

void HeadSizes::add(const FrameMatrixD& frames, const HeadAnchor& anchor) {
  Eigen::Matrix3Xd points(3, anchor.groups.size());
  for (Eigen::Index k = 0; k < frames.rows(); ++k) {
    const Eigen::VectorXd frame = frames.row(k);
    if (!anchor_is_whole(frame, anchor)) {
      continue;
    }
    for (std::size_t i = 0; i < anchor.groups.size(); ++i) {
      points.col(static_cast<Eigen::Index>(i)) = marker_of(frame, anchor.groups[i]);
    }
    if (const double size = point_spread(points); size > 0.0) {
      const double logarithm = std::log(size);
      count_ += 1;
      sum_ += logarithm;
      sum_of_squares_ += logarithm * logarithm;
    }
  }
}

void HeadSizes::add(const HeadSizes& other) {
  count_ += other.count_;
  sum_ += other.sum_;
  sum_of_squares_ += other.sum_of_squares_;
}

double HeadSizes::squared_deviations() const {
  return count_ == 0 ? 0.0
                     : std::max(0.0, sum_of_squares_ - sum_ * sum_ / static_cast<double>(count_));
}

FoundScale choose_scale(const ScaleSayings& sayings, const std::map<std::string, HeadSizes>& sizes,
                        const HeadAnchor& anchor, const std::string& where) {
  double squares = 0.0;
  std::int64_t frames = 0;
  for (const auto& [speaker, own] : sizes) {
    squares += own.squared_deviations();
    frames += own.count();
  }
  FoundScale found;
  found.size_variation = frames == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(frames));
  const auto choose = [&](std::optional<Scale> scale, const char* origin) {
    if (scale && found.origin.empty()) {
      found.scale = *scale;
      found.origin = origin;
    }
  };
  choose(sayings.asked, "asked for");
  choose(sayings.layout, "layout");
  choose(sayings.database, "database");
  choose(found.size_variation > kMostMeasuredVariation ? Scale::nominal : Scale::measured, "found");
  if (found.scale == Scale::nominal && !anchor.gives_rotation) {
    throw InputError({.where = where,
                      .what = "the scale is nominal, and the layout cannot tell the head's size",
                      .expected = "at least three rigid groups",
                      .got = fmt::format("{}", anchor.groups.size()),
                      .remedy = "Name more rigid groups, or call the scale measured."});
  }
  return found;
}

} // namespace phonomime
