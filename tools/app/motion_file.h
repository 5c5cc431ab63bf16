// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"
#include "db/types/motion_table.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

struct MotionFileOptions {
  // layout.json of the corpus that the file is from, where its unit or axes are not the database's
  // own (mm, x to the right of the picture, y up, z towards the camera); empty: they are. A unit
  // that the file itself says is believed in either case (a CSV of markers is in mm).
  std::filesystem::path layout;
  double gap_limit_s = 0.1; // longest gap that is filled
};

// A motion file in a database's layout and in the frame of its speaker's head.
struct MotionFile {
  std::filesystem::path path;
  double recorded_hz = 0.0;                // the file's rate
  double duration_s = 0.0;                 // of its frames; the first is at 0
  double rate_hz = 0.0;                    // of what follows
  FrameMatrixD channels;                   // #frames by #channels, mm or weights; finite everywhere
  std::vector<HeadPose> head;              // what was taken off; empty for weights
  std::vector<std::uint8_t> frame_has_gap; // #frames; 1 = a channel was missing and not filled
  std::vector<std::string> notes;          // for people: gaps, groups that are not used

  Eigen::Index frame_count() const { return channels.rows(); }
};

// Reads a .csv (marker or weight table, Live Link Face take) or .c3d (read_motion) as an import
// into the database of `table` would: groups by their names, head motion off by the speaker's
// reference pose, gaps filled, resampled to `rate_hz` (0: the database's). Throws InputError: what
// read_motion and to_layout throw, a group that no frame has, no frame with the head's pose; and
// IoError.
MotionFile read_motion_file(const std::filesystem::path& path, const MotionTable& table,
                            const MotionFileOptions& options = {}, double rate_hz = 0.0);

// The same of a file that has been read: `path` is what it is called.
MotionFile motion_in_layout(const MotionClip& clip, const std::filesystem::path& path,
                            const MotionTable& table, const MotionFileOptions& options = {},
                            double rate_hz = 0.0);

// Its frames in the PCA of `table` (#frames by #dimensions), and how far the PCA's frames are from
// them (root mean square over all channels, mm or weight).
struct ProjectedMotion {
  FrameMatrixD coefficients;
  double residual = 0.0;
};
ProjectedMotion project_motion(const MotionFile& motion, const PcaModel& pca);

} // namespace phonomime
