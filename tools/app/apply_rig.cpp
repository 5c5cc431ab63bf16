// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/apply_rig.h"

#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "synth/retarget/weight_filter.h"
#include "tools/app/motion_file.h"
#include "tools/app/option_checks.h"
#include "tools/app/rig_target_files.h"

namespace phonomime {

ApplyRigReport apply_rig(const ApplyRigOptions& options, const Progress& progress) {
  options.weights.over({});
  check_range("--filter", options.filter_s, 0.0, 1.0);
  check_range("--fps", options.fps, 0.0, 1000.0);
  check_outputs_differ(options.outputs);
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.speaker);
  const RigInUse used = read_rig(options.choice.rig, table);
  for (const std::filesystem::path& output : options.outputs) {
    check_rig_output(output, used.rig.target);
  }
  const RigTargetFiles target(used.rig, used.folder);
  progress.update("reading the motion", 0, 1);
  const MotionFile motion =
      read_motion_file(options.motion, table, {.layout = options.layout}, options.fps);
  progress.update("decomposing", 0, 1);
  const FrameMatrixD weights =
      filter_weights(decompose_by_rig(used, options.choice, options.weights, table, motion),
                     motion.rate_hz, options.filter_s);
  const GlbNotes notes{.title = options.motion.stem().string(),
                       .credits = {"Motion of " + table.speaker},
                       .synthetic = table.synthetic};
  OutputFiles files;
  for (const std::filesystem::path& output : options.outputs) {
    files.stage(output, target.bytes(output, weights, motion.rate_hz, notes));
  }
  files.commit();
  return {.target = std::string(kRigTargetNames[static_cast<std::size_t>(used.rig.target)]),
          .frames = static_cast<long>(weights.rows()),
          .rate_hz = motion.rate_hz,
          .keyshapes = static_cast<std::size_t>(weights.cols()),
          .used = static_cast<std::size_t>((weights.array() != 0.0).colwise().any().count()),
          .conflicts = find_conflicts(used.rig, table.layout, used.keyshapes, target.targets()),
          .notes = motion.notes,
          .written = options.outputs};
}

} // namespace phonomime
