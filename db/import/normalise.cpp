// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/normalise.h"

#include "db/import/head.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <string>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

// Neither the fill of a gap nor a low-pass may swing beyond what was recorded where the ends mean
// something: a weight of 0 is nothing at all. `recorded` may lack values (NaN).
void keep_recorded_range(FrameMatrixD& channels, const FrameMatrixD& recorded) {
  for (Eigen::Index c = 0; c < channels.cols(); ++c) {
    const double least = recorded.col(c).minCoeff<Eigen::PropagateNumbers>();
    const double most = recorded.col(c).maxCoeff<Eigen::PropagateNumbers>();
    channels.col(c) = channels.col(c).cwiseMax(least).cwiseMin(most);
  }
}

HeadFree still_head(const FrameMatrixD& recorded, const Layout& layout,
                    const Eigen::VectorXd& reference_pose, Scale scale,
                    const NormaliseOptions& options) {
  if (layout.kind == LayoutKind::weights) {
    HeadFree free;
    free.local = recorded;
    return free;
  }
  const HeadAnchor anchor = head_anchor(layout);
  HeadFree free = remove_head(recorded, anchor, reference_pose, scale);
  if (!free.found) {
    throw InputError({.where = options.where,
                      .what = fmt::format("no frame of {} gives the head's pose", options.whose),
                      .expected = anchor.gives_rotation
                                      ? "a frame with three rigid markers, not on a line"
                                      : "a frame with the reference marker"});
  }
  return free;
}

} // namespace

NormalMotion normalise(const FrameMatrixD& recorded, const SourceClock& clock, const Layout& layout,
                       const Eigen::VectorXd& reference_pose, Scale scale,
                       const NormaliseOptions& options) {
  const HeadFree still = still_head(recorded, layout, reference_pose, scale, options);
  GapFill filled =
      fill_gaps(still.local, layout.channels_per_group(), clock.rate_hz, options.gap_limit_s);
  NormalMotion result;
  result.channels = resample(filled.frames, clock, options.rate_hz, options.frames);
  result.frame_has_gap =
      resample_marks(filled.frame_has_gap, clock, options.rate_hz, options.frames);
  if (layout.kind == LayoutKind::weights) {
    keep_recorded_range(result.channels, recorded);
  } else {
    result.head = resample_head(still.head, clock, options.rate_hz, options.frames);
  }
  result.gaps = std::move(filled.gaps);
  result.interpolated_poses = still.interpolated;
  return result;
}

void check_groups(const FrameMatrixD& recorded, const Layout& layout, const std::string& where,
                  const std::string& whose, const std::string& remedy) {
  const std::vector<int> missing = groups_missing_throughout(recorded, layout.channels_per_group());
  if (missing.empty()) {
    return;
  }
  const auto count = static_cast<int>(missing.size());
  const std::string& first = layout.groups[static_cast<std::size_t>(missing.front())].name;
  throw InputError(
      {.where = where,
       .what = fmt::format("{} of {} groups missing throughout the motion of {}: {}{}",
                           count == layout.group_count() ? "all" : fmt::format("{}", count),
                           layout.group_count(), whose, quoted(first), count > 1 ? ", ..." : ""),
       .expected = "each group in at least one frame",
       .remedy = remedy});
}

} // namespace phonomime
