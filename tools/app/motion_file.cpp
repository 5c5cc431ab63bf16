// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/motion_file.h"

#include "db/import/channels.h"
#include "db/import/normalise.h"
#include "db/import/readers.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/frame_times.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

// The database's groups with the unit and the axes that the file has.
Layout layout_of_file(const MotionClip& clip, const MotionTable& table,
                      const MotionFileOptions& options) {
  Layout layout = table.layout;
  if (!options.layout.empty()) {
    const Layout named = parse_layout(read_file(options.layout), options.layout.string());
    layout.unit_mm = named.unit_mm;
    layout.axes = named.axes;
  }
  if (clip.unit_mm > 0.0) {
    layout.unit_mm = clip.unit_mm;
  }
  return layout;
}

void tell_gaps(const NormalMotion& motion, double recorded_hz, MotionFile& file) {
  const std::string name = file.path.string();
  std::int64_t filled = 0;
  for (const Gap& gap : motion.gaps) {
    filled += gap.action == GapAction::marked ? 0 : 1;
  }
  if (filled > 0) {
    file.notes.push_back(fmt::format("{}: {} gaps filled", name, filled));
  }
  const auto longest =
      std::ranges::max_element(motion.gaps, {}, [](const Gap& gap) { return gap.frame_count; });
  if (longest != motion.gaps.end() && longest->action == GapAction::marked) {
    file.notes.push_back(fmt::format(
        "{}: {} gaps too long to fill are bridged by lines, the longest {} s from {} s on", name,
        static_cast<std::int64_t>(motion.gaps.size()) - filled,
        format_number(static_cast<double>(longest->frame_count) / recorded_hz),
        format_number(static_cast<double>(longest->first_frame) / recorded_hz)));
  }
}

} // namespace

MotionFile read_motion_file(const std::filesystem::path& path, const MotionTable& table,
                            const MotionFileOptions& options, double rate_hz) {
  return motion_in_layout(read_motion(path), path, table, options, rate_hz);
}

MotionFile motion_in_layout(const MotionClip& clip, const std::filesystem::path& path,
                            const MotionTable& table, const MotionFileOptions& options,
                            double rate_hz) {
  const Layout layout = layout_of_file(clip, table, options);
  const LayoutMotion recorded = to_layout(clip, layout, path.string());
  const std::string whose = "the file";
  check_groups(recorded.frames, layout, path.string(), whose,
               "Check the recording, or use one that has them.");
  MotionFile file{.path = path,
                  .recorded_hz = recorded.rate_hz,
                  .duration_s = clip.duration_s(),
                  .rate_hz = rate_hz > 0.0 ? rate_hz : table.rate_hz};
  NormalMotion motion =
      normalise(recorded.frames, {.rate_hz = recorded.rate_hz}, layout, table.reference_pose,
                layout.scale.value_or(Scale::measured),
                {.where = path.string(),
                 .whose = whose,
                 .gap_limit_s = options.gap_limit_s,
                 .rate_hz = file.rate_hz,
                 .frames = std::max<Eigen::Index>(
                     1, static_cast<Eigen::Index>(first_frame_at(file.duration_s, file.rate_hz)))});
  if (!recorded.extra_groups.empty()) {
    file.notes.push_back(fmt::format("{}: {} groups that the database does not have: {}",
                                     path.string(), recorded.extra_groups.size(),
                                     fmt::join(recorded.extra_groups, " ")));
  }
  tell_gaps(motion, recorded.rate_hz, file);
  file.channels = std::move(motion.channels);
  file.head = std::move(motion.head);
  file.frame_has_gap = std::move(motion.frame_has_gap);
  return file;
}

ProjectedMotion project_motion(const MotionFile& motion, const PcaModel& pca) {
  ProjectedMotion projected;
  projected.coefficients.resize(motion.frame_count(), pca.dimension_count());
  double sum_sq = 0.0;
  for (Eigen::Index k = 0; k < motion.frame_count(); ++k) { // by frames: the same on all machines
    const Eigen::VectorXd channels = motion.channels.row(k).transpose();
    const Eigen::VectorXd coefficients = pca.project(channels);
    projected.coefficients.row(k) = coefficients.transpose();
    sum_sq += (channels - pca.reconstruct(coefficients)).squaredNorm();
  }
  projected.residual =
      std::sqrt(sum_sq / static_cast<double>(std::max<Eigen::Index>(1, motion.channels.size())));
  return projected;
}

} // namespace phonomime
