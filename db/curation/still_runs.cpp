// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/curation/still_runs.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

constexpr double kWholeFace_s = 0.2;
constexpr Eigen::Index kWholeFaceFrames = 5;
constexpr Eigen::Index kLeastFrames = 3;
constexpr double kOthersMove_mm = 0.3;
constexpr std::size_t kNearest = 8;
constexpr double kAtRestShare = 0.9;
constexpr double kRounding_s = 1e-9;

struct Stretch {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};

// Stretches of frames in which columns [column, column + width) stay within the tolerance of the
// stretch's first frame; those of one frame too.
std::vector<Stretch> stretches(const FrameMatrixD& frames, Eigen::Index column, Eigen::Index width,
                               double tolerance) {
  std::vector<Stretch> found;
  for (Eigen::Index k = 0; k < frames.rows(); ++k) {
    if (!found.empty()) {
      const Stretch& last = found.back();
      bool same = true;
      for (Eigen::Index c = column; c < column + width && same; ++c) {
        same = std::abs(frames(k, c) - frames(last.first, c)) <= tolerance; // false for NaN
      }
      if (same) {
        ++found.back().count;
        continue;
      }
    }
    found.push_back({k, 1});
  }
  return found;
}

// Diagonal of the box that a marker stays in over a stretch; 0 where it is missing in between.
double motion_of(const FrameMatrixD& frames, int marker, const Stretch& stretch) {
  const auto block = frames.block(stretch.first, 3 * marker, stretch.count, 3);
  return block.allFinite() ? (block.colwise().maxCoeff() - block.colwise().minCoeff()).norm() : 0.0;
}

// Median motion of the nearest markers that move at all; 0 where none does.
double motion_around(const FrameMatrixD& frames, int marker, int markers, const Stretch& stretch,
                     double tolerance) {
  std::vector<std::pair<double, int>> nearest;
  for (int other = 0; other < markers; ++other) {
    const double distance = (frames.row(stretch.first).segment(3 * other, 3) -
                             frames.row(stretch.first).segment(3 * marker, 3))
                                .norm();
    if (other != marker && std::isfinite(distance)) {
      nearest.emplace_back(distance, other);
    }
  }
  std::ranges::sort(nearest);
  std::vector<double> motions;
  for (const auto& [distance, other] : nearest) {
    const double motion = motion_of(frames, other, stretch);
    if (motion > 2.0 * tolerance) {
      motions.push_back(motion);
    }
    if (motions.size() == kNearest) {
      break;
    }
  }
  std::ranges::sort(motions);
  return motions.empty() ? 0.0 : motions[motions.size() / 2];
}

} // namespace

std::vector<StillRun> still_runs(const FrameMatrixD& frames, const Layout& layout, double rate_hz,
                                 const StillLimits& limits) {
  std::vector<StillRun> runs;
  const auto lasts = [&](const Stretch& stretch, double least_s, Eigen::Index least_frames) {
    return stretch.count >= least_frames &&
           static_cast<double>(stretch.count) / rate_hz >= least_s - kRounding_s;
  };
  for (const Stretch& stretch : stretches(frames, 0, frames.cols(), limits.tolerance)) {
    if (lasts(stretch, kWholeFace_s, kWholeFaceFrames)) {
      runs.push_back({.group = -1, .first_frame = stretch.first, .frame_count = stretch.count});
    }
  }
  if (layout.kind == LayoutKind::weights) {
    return runs;
  }
  for (int marker = 0; marker < layout.group_count(); ++marker) {
    std::vector<Stretch> still = stretches(frames, 3 * marker, 3, limits.tolerance);
    Eigen::Index at_rest = 0;
    for (const Stretch& stretch : still) {
      at_rest += stretch.count > 1 ? stretch.count : 0;
    }
    if (static_cast<double>(at_rest) >= kAtRestShare * static_cast<double>(frames.rows())) {
      continue;
    }
    std::erase_if(still, [&](const Stretch& stretch) {
      return !lasts(stretch, limits.least_s, kLeastFrames);
    });
    for (const Stretch& stretch : still) {
      const double others =
          motion_around(frames, marker, layout.group_count(), stretch, limits.tolerance);
      if (others >= kOthersMove_mm) {
        runs.push_back({.group = marker,
                        .first_frame = stretch.first,
                        .frame_count = stretch.count,
                        .others = others});
      }
    }
  }
  return runs;
}

} // namespace phonomime
